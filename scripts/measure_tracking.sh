#!/usr/bin/env bash
# Judges the trackers on simulated flights of every regime: the tables of docs/benchmarks/tracking.md.
#
#   scripts/measure_tracking.sh RESULTS [SEEDS [SECONDS [REGIMES]]]
#
# RESULTS: folder for bags and tables; flights and baselines that are there are used again. SEEDS: one or more in quotes ("1 2"). SECONDS: of a flight (20).
# REGIMES: only the first table, for these in quotes ("fast corridor").
set -euo pipefail
case ${1:-} in
  --help | -h | "") sed -n '2,7s/^# \{0,1\}//p' "$0" && exit ;;
esac
mkdir -p "$1"
results=$(cd "$1" && pwd)
seeds=${2:-1}
seconds=${3:-20}
. "$(dirname "$0")/environment.sh"
. scripts/regimes.sh
scripts/build.sh
sourceSetup "$build/devel/setup.bash"
tools=$build/devel/lib/tet_line_tracker

regimes=${4:-slow fast corridor low gain shake rotation moving all}

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
      [ -e "$flight" ] || "$tools/simulate_bag" "$flight" ${flights[$regime]} --seconds "$seconds" --seed "$seed"
      lines=$results/$regime-$seed-$name.bag
      # Baselines do not change with the package: once is enough.
      [[ $* == *--tracker* && -e $lines ]] || "$tools/track_bag" "$flight" "$lines" --times "$@" >"${lines%.bag}.txt"
      tracked+=("$lines")
    done
  done
  echo "== $name $*"
  "$tools/evaluate_tracks" "${tracked[@]}"
}

{
  judge joint "$regimes"
  judge lk_endpoints "$regimes" --tracker lk_endpoints
  judge lsd_lbd_knn "$regimes" --tracker lsd_lbd_knn
  [ $# -lt 4 ] || exit 0
  hard="fast corridor gain shake"
  judge no_prior "$hard" --set prior=none
  judge no_gain_and_offset "$hard" --set gain_and_offset=false
  judge no_robust_patches "$hard" --set robust_patches=false
  judge no_refine "$hard" --set refine=false --set finest_level=0
  judge image_prior "$hard" --set prior=image
  judge no_parallax "$hard" --set predict_parallax=false
  judge no_edge_offset "$hard" --set max_edge_offset=10
} | tee "$results/tables.txt"
