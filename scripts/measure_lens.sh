#!/usr/bin/env bash
# Judges the undistorted ends of lines by the true edges, by class of length and lens: the tables of docs/benchmarks/lens.md.
#
#   scripts/measure_lens.sh RESULTS [SEED [SECONDS]]
#
# RESULTS: folder for bags and tables; flights that are there are used again. SEED: of the flights (1001). SECONDS: of a flight (10).
set -euo pipefail
case ${1:-} in
  --help | -h | "") sed -n '2,6s/^# \{0,1\}//p' "$0" && exit ;;
esac
mkdir -p "$1"
results=$(cd "$1" && pwd)
seed=${2:-1001}
seconds=${3:-10}
. "$(dirname "$0")/environment.sh"
scripts/build.sh
sourceSetup "$build/devel/setup.bash"
tools=$build/devel/lib/tet_line_tracker

# A lens that bends nothing; the others come with the package.
cat >"$results/pinhole.yaml" <<END
image_width: 752
image_height: 480
camera_name: pinhole
camera_matrix: {rows: 3, cols: 3, data: [458, 0, 376, 0, 458, 240, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}
END
declare -A lenses=([pinhole]=$results/pinhole.yaml [euroc]=config/euroc_cam0.yaml [tum_fr1]=config/tum_freiburg1.yaml)

for tracker in tet lsd_lbd_knn; do
  tracked=()
  for lens in pinhole euroc tum_fr1; do
    for motion in slow fast corridor shake; do
      flight=$results/$lens-$motion.bag
      [ -e "$flight" ] ||
        "$tools/simulate_bag" "$flight" --motion $motion --camera-info "${lenses[$lens]}" --seconds "$seconds" --seed "$seed"
      lines=${flight%.bag}-$tracker.bag
      "$tools/track_bag" "$flight" "$lines" --tracker $tracker >"${lines%.bag}.txt"
      tracked+=("$lines")
    done
  done
  echo "== $tracker"
  "$tools/evaluate_tracks" --absolute "${tracked[@]}"
done | tee "$results/tables.txt"
