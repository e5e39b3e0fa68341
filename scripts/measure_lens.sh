#!/usr/bin/env bash
# Judges the undistorted ends of lines by the true edges, by class of length and lens: the tables of docs/benchmarks/lens.md.
#
#   scripts/measure_lens.sh RESULTS [--tuning] [SEED [SECONDS]]
#
# RESULTS: folder for bags and tables; flights that are there are used again. SEED: of the flights (1001), from 1000 on; below 1000
# with --tuning. SECONDS: of a flight (10).
set -euo pipefail
. "$(dirname "$0")/measuring.sh"
seed=${arguments[0]:-$(defaultSeeds)}
seconds=${arguments[1]:-10}
requireSeeds "$seed"
prepareTools

# One that bends nothing; the others come with the package.
writeLens "$results/pinhole.yaml" 752 480 458 376 240 plumb_bob "0, 0, 0, 0, 0"
declare -A lenses=([pinhole]=$results/pinhole.yaml [euroc]=config/euroc_cam0.yaml [tum_fr1]=config/tum_freiburg1.yaml)

for tracker in tet lsd_lbd_knn; do
  tracked=()
  for lens in pinhole euroc tum_fr1; do
    for motion in slow fast corridor shake; do
      flight=$results/$lens-$motion-$seed.bag
      simulate "$flight" "$seed" --motion $motion --camera-info "${lenses[$lens]}" --seconds "$seconds"
      lines=${flight%.bag}-$tracker.bag
      "$tools/track_bag" "$flight" "$lines" --tracker $tracker >"${lines%.bag}.txt"
      tracked+=("$lines")
    done
  done
  heading "$tracker"
  "$tools/evaluate_tracks" --absolute "${tracked[@]}"
done | tee "$results/tables.txt"
