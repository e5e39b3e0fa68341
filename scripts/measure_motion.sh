#!/usr/bin/env bash
# Judges the trackers where the camera moves far between two images: the tables of docs/benchmarks/motion.md.
#
#   scripts/measure_motion.sh RESULTS [--tuning] [SEEDS [SECONDS]]
#
# RESULTS: folder for bags and tables. All that is there is used again: remove *-tet.* and *-part-* after a change of the package. SEEDS: of the
# flights, one or more in quotes ("1001 1002"), from 1000 on; below 1000 with --tuning. SECONDS: of a flight (20). Recorded sequences
# are the extracts in ../shared/data (or TET_SHARED_DATA), judged by their poses; those that are not there are skipped.
set -euo pipefail
. "$(dirname "$0")/measuring.sh"
. scripts/regimes.sh
seeds=${arguments[0]:-$(if $tuning; then echo 3; else echo 1001 1002; fi)}
seconds=${arguments[1]:-20}
# shellcheck disable=SC2086
requireSeeds $seeds
prepareTools

# judge SEQUENCE: SEQUENCE.bag by all trackers, one JSON file each.
judge() {
  local tracker lines
  for tracker in tet lsd_lbd_knn lk_endpoints; do
    lines=$results/$1-$tracker
    [ -e "$lines.bag" ] || "$tools/track_bag" "$results/$1.bag" "$lines.bag" --tracker $tracker >"$lines.txt"
    [ "$lines.json" -nt "$lines.bag" ] || "$tools/evaluate_tracks" "$lines.bag" --json "$lines.json" >>"$lines.txt"
  done
}

# fly NAME SEED simulate_bag options
fly() {
  local flight=$1-$2
  simulate "$results/$flight.bag" "$2" "${@:3}" --seconds "$seconds" >/dev/null
  judge "$flight"
}

# record NAME FORMAT FOLDER [dataset_to_bag options]
record() {
  local folder=${TET_SHARED_DATA:-../shared/data}/$3
  if [ ! -e "$folder" ]; then
    echo "skipped: $1, $folder is not there"
    return
  fi
  [ -e "$results/$1.bag" ] || "$tools/dataset_to_bag" "$2" "$folder" "$results/$1.bag" "${@:4}" >/dev/null
  judge "$1"
}

for seed in $seeds; do
  for regime in slow fast corridor shake; do
    # The regime's words are options.
    # shellcheck disable=SC2086
    for rate in 20 10 5 3.3; do fly "$regime-$rate" "$seed" ${flights[$regime]} --rate "$rate"; done
  done
  # shellcheck disable=SC2086
  fly street-10 "$seed" ${flights[street]}
done
record kitti_00 kitti kitti_00
record euroc_v1_01 euroc euroc_v1_01/mav0
record euroc_v1_01-every_2nd euroc euroc_v1_01/mav0 --every 2
record euroc_v1_01-every_4th euroc euroc_v1_01/mav0 --every 4

# judgeWithout NAME SEQUENCE OPTION...: the default with options set.
judgeWithout() {
  local lines=$results/$2-part-$1
  [ -e "$lines.bag" ] || "$tools/track_bag" "$results/$2.bag" "$lines.bag" --times "${@:3}" >"$lines.txt"
  [ "$lines.json" -nt "$lines.bag" ] || "$tools/evaluate_tracks" "$lines.bag" --json "$lines.json" >>"$lines.txt"
}
parts=()
for seed in $seeds; do parts+=("fast-20-$seed" "fast-5-$seed" "fast-3.3-$seed" "corridor-5-$seed" "corridor-3.3-$seed" "street-10-$seed"); done
if [ -e "$results/kitti_00.bag" ]; then parts+=(kitti_00); fi
for sequence in "${parts[@]}"; do
  judgeWithout default "$sequence"
  judgeWithout depth_check "$sequence" --set check_depth=false
  judgeWithout ego_motion "$sequence" --set ego_motion=false
  judgeWithout imu "$sequence" --set prior=image
  judgeWithout prior "$sequence" --set prior=none
done

# A car with and without an odometry of its wheels.
for seed in $seeds; do
  for rate in 10 5 3.3; do
    sequence=street-odometry-$rate-$seed
    # shellcheck disable=SC2086
    simulate "$results/$sequence.bag" "$seed" ${flights[street]} --rate "$rate" --odometry --seconds "$seconds" >/dev/null
    for prior in image odometry auto; do judgeWithout "$prior" "$sequence" --set prior=$prior; done
  done
done

# The seeds are one word each.
# shellcheck disable=SC2086
python3 scripts/motion_tables.py "$results" $seeds | tee "$results/tables.md"
