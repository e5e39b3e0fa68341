#!/usr/bin/env bash
# Judges the undistorted ends of lines by the true edges, by class of length and lens: the tables of docs/benchmarks/lens.md.
#
#   scripts/measure_lens.sh RESULTS [SEED [SECONDS]]
#
# RESULTS: folder for bags and tables; flights that are there are used again. SEED: of the flights (1001). SECONDS: of a flight (10).
# Beside the default: its lines without knowledge of the bend (tet_chord), and LSD on undistorted images (lsd_remapped).
set -euo pipefail
case ${1:-} in
  --help | -h | "") sed -n '2,7s/^# \{0,1\}//p' "$0" && exit ;;
esac
mkdir -p "$1"
results=$(cd "$1" && pwd)
seed=${2:-1001}
seconds=${3:-10}
. "$(dirname "$0")/environment.sh"
scripts/build.sh
sourceSetup "$build/devel/setup.bash"
tools=$build/devel/lib/tet_line_tracker

# lens NAME WIDTH HEIGHT F CX CY MODEL COEFFICIENTS: a calibration file; the others come with the package.
lens() {
  cat >"$results/$1.yaml" <<END
image_width: $2
image_height: $3
camera_name: $1
camera_matrix: {rows: 3, cols: 3, data: [$4, 0, $5, 0, $4, $6, 0, 0, 1]}
distortion_model: $7
distortion_coefficients: {rows: 1, cols: $(wc -w <<<"${8//,/ }"), data: [$8]}
END
}
lens pinhole 752 480 458 376 240 plumb_bob "0, 0, 0, 0, 0"               # bends nothing
lens equidistant 752 752 226.7 375.5 375.5 equidistant "0, 0, 0, 0"      # 190 degrees
lens mei 700 700 668.2 349.5 349.5 mei "2.2134, 0.0168, 1.6549, 0, 0"    # 185 degrees, as KITTI-360
declare -A lenses=(
  [pinhole]=$results/pinhole.yaml [euroc]=config/euroc_cam0.yaml [tum_fr1]=config/tum_freiburg1.yaml
  [equidistant]=$results/equidistant.yaml [mei]=$results/mei.yaml)

for tracker in tet tet_chord lsd_remapped; do
  tracked=()
  for lens in pinhole euroc tum_fr1 equidistant mei; do
    # A lens that bends nothing has no chords.
    if [ $lens-$tracker = pinhole-tet_chord ]; then continue; fi
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
  "$tools/evaluate_tracks" --absolute --csv "$results/$tracker.csv" "${tracked[@]}"
done | tee "$results/evaluation.txt"
scripts/lens_table.py "tet=$results/tet.csv" "tet_chord=$results/tet_chord.csv" "lsd_remapped=$results/lsd_remapped.csv" |
  tee "$results/tables.md"
