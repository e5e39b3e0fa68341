#!/usr/bin/env bash
# Compares the tracker with other methods on the same flights and on EuRoC V1_01: the table of docs/benchmarks/methods.md.
#
#   scripts/measure_methods.sh RESULTS [--tuning] [SEED [SECONDS]]
#
# RESULTS: folder for bags and tables; flights that are there are used again. SEED: of the flights (1001), from 1000 on; below 1000
# with --tuning. SECONDS: of a flight (10). EuRoC is looked for in ../shared/data (or TET_SHARED_DATA).
# Methods that this OpenCV has no parts for are left out, with a sentence. Times are of the processor, one method after the other on
# each flight; they count only where nothing else runs.
set -euo pipefail
. "$(dirname "$0")/measuring.sh"
takeSeedAndSeconds 10
prepareTools

methods=(joint joint_image_prior paper lsd_lbd_knn ed_lbd_knn fld_lbd_knn lsd_remapped lk_endpoints)
declare -A options=([joint]="" [joint_image_prior]="--set prior=image" [paper]="--set method=paper")

# The first three lie on straight lines in the image, the last bends as EuRoC's lens does.
writeLens "$results/pinhole.yaml" 752 480 458 376 240 plumb_bob "0, 0, 0, 0, 0"
sequences=()
for motion in slow fast corridor; do
  sequences+=("$motion")
  simulate "$results/$motion.bag" "$seed" --motion $motion --camera-info "$results/pinhole.yaml" --seconds "$seconds"
done
sequences+=(slow_lens)
simulate "$results/slow_lens.bag" "$seed" --motion slow --camera-info config/euroc_cam0.yaml --seconds "$seconds"
euroc=${TET_SHARED_DATA:-../shared/data}/euroc_v1_01/mav0
if [ -e "$euroc" ]; then
  sequences+=(euroc_v1_01)
  [ -e "$results/euroc_v1_01.bag" ] || "$tools/dataset_to_bag" euroc "$euroc" "$results/euroc_v1_01.bag" </dev/null
else
  echo "skipped: euroc_v1_01 is not in ${TET_SHARED_DATA:-../shared/data}"
fi

# track SEQUENCE METHOD: fails when this build has no such method, with a sentence of track_bag.
track() {
  local lines=$results/$1-$2
  # The method's words are options.
  # shellcheck disable=SC2086
  "$tools/track_bag" "$results/$1.bag" "$lines.bag" ${options[$2]---tracker $2} >"$lines.txt" 2>"$lines.log" && return
  grep 'this build has no tracker' "$lines.log" >&2 || fail "track_bag failed: $(tail -n 1 "$lines.log")"
  return 1
}

known=()
for method in "${methods[@]}"; do
  if track "${sequences[0]}" "$method"; then known+=("$method"); fi
done
for sequence in "${sequences[@]:1}"; do
  for method in "${known[@]}"; do track "$sequence" "$method"; done
done
tracked=("${sequences[@]/#/$results/}")
for method in "${known[@]}"; do
  heading "$method"
  "$tools/evaluate_tracks" --absolute --csv "$results/$method.csv" "${tracked[@]/%/-$method.bag}"
done | tee "$results/evaluation.txt"
scripts/methods_table.py "$results" "${known[@]}" | tee "$results/tables.md"
