#!/usr/bin/env bash
# Judges the trackers on simulated flights of every regime: the tables of docs/benchmarks/tracking.md.
#
#   scripts/measure_tracking.sh RESULTS [--tuning] [SEEDS [SECONDS [REGIMES]]]
#
# RESULTS: folder for bags and tables; flights and baselines that are there are used again. SEEDS: one or more in quotes (1001),
# from 1000 on; below 1000 with --tuning. SECONDS: of a flight (20). REGIMES: only the first table, for these in quotes
# ("fast corridor").
set -euo pipefail
. "$(dirname "$0")/measuring.sh"
. scripts/regimes.sh
seeds=${arguments[0]:-$(defaultSeed)}
seconds=${arguments[1]:-20}
regimes=${arguments[2]:-slow fast corridor low gain shake rotation moving all}
# Seeds and regimes are words.
# shellcheck disable=SC2086
requireSeeds $seeds
prepareTools

# judge NAME REGIMES [track_bag options]: tracks the flights and prints one table.
judge() {
  local name=$1 tracked=() flight lines
  local chosen=$2
  shift 2
  for regime in $chosen; do
    for seed in $seeds; do
      flight=$results/$regime-$seed.bag
      # The regime's words are options.
      # shellcheck disable=SC2086
      simulate "$flight" "$seed" ${flights[$regime]} --seconds "$seconds"
      lines=$results/$regime-$seed-$name.bag
      # Baselines do not change with the package: once is enough.
      [[ $* == *--tracker* && -e $lines ]] || "$tools/track_bag" "$flight" "$lines" --times "$@" >"${lines%.bag}.txt"
      tracked+=("$lines")
    done
  done
  heading "$name" "$@"
  "$tools/evaluate_tracks" "${tracked[@]}"
}

{
  judge joint "$regimes"
  judge lk_endpoints "$regimes" --tracker lk_endpoints
  judge lsd_lbd_knn "$regimes" --tracker lsd_lbd_knn
  [ ${#arguments[@]} -lt 3 ] || exit 0
  hard="fast corridor gain shake"
  judge no_prior "$hard" --set prior=none
  judge no_gain_and_offset "$hard" --set gain_and_offset=false
  judge no_robust_patches "$hard" --set robust_patches=false
  judge no_refine "$hard" --set refine=false --set finest_level=0
  judge image_prior "$hard" --set prior=image
  judge no_parallax "$hard" --set predict_parallax=false
  judge no_edge_offset "$hard" --set max_edge_offset=10
} | tee "$results/tables.txt"
