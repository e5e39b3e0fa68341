#!/usr/bin/env bash
# Judges the undistorted ends of lines by the true edges, by class of length and lens: the tables of docs/benchmarks/lens.md.
#
#   scripts/measure_lens.sh RESULTS [--tuning] [SEED [SECONDS]]
#
# RESULTS: folder for bags and tables; flights that are there are used again. SEED: of the flights (1001), from 1000 on; below 1000
# with --tuning. SECONDS: of a flight (10).
# Beside the default: its lines without knowledge of the bend (tet_chord), and LSD on undistorted images (lsd_remapped).
set -euo pipefail
. "$(dirname "$0")/measuring.sh"
takeSeedAndSeconds 10
prepareTools

# The others come with the package.
writeLens "$results/pinhole.yaml" 752 480 458 376 240 plumb_bob "0, 0, 0, 0, 0"                        # bends nothing
writeLens "$results/equidistant.yaml" 752 752 226.7 375.5 375.5 equidistant "0, 0, 0, 0"               # 190 degrees
writeLens "$results/mei.yaml" 700 700 668.2 349.5 349.5 mei "2.2134, 0.0168, 1.6549, 0, 0"  # 185 degrees, as KITTI-360
declare -A lenses=(
  [pinhole]=$results/pinhole.yaml [euroc]=config/euroc_cam0.yaml [tum_fr1]=config/tum_freiburg1.yaml
  [equidistant]=$results/equidistant.yaml [mei]=$results/mei.yaml)

for tracker in tet tet_chord lsd_remapped; do
  tracked=()
  for lens in pinhole euroc tum_fr1 equidistant mei; do
    # A lens that bends nothing has no chords.
    if [ $lens-$tracker = pinhole-tet_chord ]; then continue; fi
    for motion in slow fast corridor shake; do
      flight=$results/$lens-$motion-$seed.bag
      simulate "$flight" "$seed" --motion $motion --camera-info "${lenses[$lens]}" --seconds "$seconds"
      lines=${flight%.bag}-$tracker.bag
      "$tools/track_bag" "$flight" "$lines" --tracker $tracker >"${lines%.bag}.txt"
      tracked+=("$lines")
    done
  done
  heading "$tracker"
  "$tools/evaluate_tracks" --absolute --csv "$results/$tracker.csv" "${tracked[@]}"
done | tee "$results/evaluation.txt"
scripts/lens_table.py "tet=$results/tet.csv" "tet_chord=$results/tet_chord.csv" "lsd_remapped=$results/lsd_remapped.csv" |
  tee "$results/tables.md"
