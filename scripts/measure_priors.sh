#!/usr/bin/env bash
# Compares the motion priors on simulated flights, on some of them with a bad IMU too (late by 30 ms, with a bias of 0.2 rad/s, turned by
# 2 degrees from where its transform says), and where it is, on EuRoC V1_01 with its own IMU: the table "Motion priors" of
# docs/benchmarks/tracking.md.
#
#   scripts/measure_priors.sh RESULTS [--tuning] [SEEDS [SECONDS [REGIMES]]]
#
# RESULTS: folder for bags and tables; flights that are there are used again. SEEDS: one or more in quotes ("1001 1002 1003"), from
# 1000 on; below 1000 with --tuning. SECONDS: of a flight (10). REGIMES: some, in quotes ("fast corridor shake-imu_late"). EuRoC is looked
# for in ../shared/data (or TET_SHARED_DATA).
set -euo pipefail
. "$(dirname "$0")/measuring.sh"
. scripts/regimes.sh
seeds=${arguments[0]:-1001 1002 1003}
if $tuning; then seeds=${arguments[0]:-1 2 3}; fi
seconds=${arguments[1]:-10}
regimes='slow fast corridor low gain shake rotation moving all'
for bad_imu in imu_late imu_biased imu_turned imu_bad; do regimes+=" fast-$bad_imu shake-$bad_imu"; done
regimes=${arguments[2]:-$regimes}
# Seeds and regimes are words.
# shellcheck disable=SC2086
requireSeeds $seeds
prepareTools

flown=()
for regime in $regimes; do
  for seed in $seeds; do
    bad_imu=
    if [[ $regime == *-* ]]; then bad_imu=${bad_imus[${regime#*-}]}; fi
    # The regime's words are options.
    # shellcheck disable=SC2086
    simulate "$results/$regime-$seed.bag" "$seed" ${flights[${regime%-*}]} $bad_imu --seconds "$seconds"
    flown+=("$regime-$seed")
  done
done
euroc=${TET_SHARED_DATA:-../shared/data}/euroc_v1_01/mav0
if [ -e "$euroc" ]; then
  [ -e "$results/euroc_v1_01.bag" ] || "$tools/dataset_to_bag" euroc "$euroc" "$results/euroc_v1_01.bag"
  flown+=(euroc_v1_01)
fi

priors=(none image imu auto)
for prior in "${priors[@]}"; do
  mkdir -p "$results/$prior"
  tracked=()
  for name in "${flown[@]}"; do
    lines=$results/$prior/$name.bag
    "$tools/track_bag" "$results/$name.bag" "$lines" --set prior="$prior" >"${lines%.bag}.txt"
    tracked+=("$lines")
  done
  "$tools/evaluate_tracks" --csv "$results/$prior.csv" "${tracked[@]}" >"$results/$prior.txt"
done
{
  heading priors
  python3 scripts/prior_table.py "${priors[@]/#/$results/}"
} | tee "$results/tables.txt"
