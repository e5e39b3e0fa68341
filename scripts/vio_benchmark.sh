#!/usr/bin/env bash
# Judges lines by the trajectory error of a real estimator, PL-VINS: docs/benchmarks/vio.md.
#
#   scripts/vio_benchmark.sh PL_VINS_CHECKOUT RESULTS [--tuning] [--seeds "SEED ..."] [--starts "S ..."] [--seconds S]
#                            [--sources "none own tet perfect"] [--launch "ARG:=VALUE ..."] [CASE ...]
#
# PL_VINS_CHECKOUT: a clone of PL-VINS (GPL), which stays as it is: a copy below build/vio is edited for today's OpenCV and Ceres
# and built there, once. RESULTS: folder for bags, logs and tables; what is there is used again, so take a new one for another
# build. CASE: room, corridor, fast, low_light, drops, all_points (default: all), a bag with true poses, or the mav0 folder of a
# EuRoC sequence. --seeds: of the flights (1001 1002), from 1000 on; below 1000 with --tuning. --starts: seconds at which the
# estimator starts, a run for each (0 4). --seconds: of a flight (30). --sources: none (points alone), own (PL-VINS's line
# tracker), tet (this package), perfect (true edges with 0.3 px of noise). --launch: arguments of pl_vins.launch.
set -euo pipefail
caller=$PWD
. "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
. scripts/seeds.sh
. scripts/vio_benchmark/port.sh

tuning=false
seeds=
options=()
places=()
while [ $# -gt 0 ]; do
  case $1 in
    --help | -h) printHelp && exit ;;
    --tuning) tuning=true ;;
    --seeds | --starts | --seconds | --sources | --launch)
      [ $# -ge 2 ] || fail "$1 needs a value; see --help"
      if [ "$1" = --seeds ]; then seeds=$2; else options+=("$1=$2"); fi
      shift
      ;;
    -*) fail "unknown option $1; see --help" ;;
    *) places+=("$1") ;;
  esac
  shift
done
[ ${#places[@]} -ge 2 ] || fail "needs PL_VINS_CHECKOUT and RESULTS; see --help"
checkout=$(cd "$caller" && realpath -m "${places[0]}")
results=$(cd "$caller" && realpath -m "${places[1]}")
cases=()
known=$(sed -n "s/^    Case('\([a-z_]*\)'.*/\1/p" scripts/vio_benchmark/flights.py)
for each in "${places[@]:2}"; do
  if ! grep -qxF -- "$each" <<<"$known"; then
    each=$(cd "$caller" && realpath -m "$each")
    [ -e "$each" ] || fail "there is no case, bag or EuRoC folder $each; cases: ${known//$'\n'/, }"
  fi
  cases+=("$each")
done
requirePlVins "$checkout"
seeds=${seeds:-$(defaultSeed) $(($(defaultSeed) + 1))}
# Seeds are words.
# shellcheck disable=SC2086
requireSeeds $seeds
mkdir -p "$results"
# A flight and what is made of it take 1 GB for each seed and 30 s of all cases; the build of PL-VINS 0.1 GB.
free=$(($(df --output=avail -k "$results" | tail -n 1) / 1024 / 1024))
[ "$free" -ge 4 ] || fail "$results has $free GB of free disk, and 4 are needed"

requireLocalhost
requirePackages "${packages_build[@]}" "${packages_run[@]}" "${packages_vio[@]}"
scripts/build.sh
sourceSetup "$build/devel/setup.bash"

work=$build/vio
stamp=$(stampOf "$checkout")
if [ "$(cat "$work/stamp" 2>/dev/null)" != "$stamp" ]; then
  rm -f "$work/stamp"
  copySources "$checkout" "$work/src"
  launcher=()
  if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  echo "Building PL-VINS, once (build/vio/build.log) ..."
  { cmake -S scripts/vio_benchmark -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "-DPL_VINS=$work/src" "${launcher[@]}" &&
    cmake --build "$work/build"; } >"$work/build.log" 2>&1 ||
    { grep -m 3 -E 'error|Error' "$work/build.log" >&2; fail "PL-VINS could not be built: see build/vio/build.log"; }
  echo "$stamp" >"$work/stamp"
fi

startMaster
python3 -B scripts/vio_benchmark/benchmark.py --programs "$work/build" --tools "$build/devel/lib/tet_line_tracker" \
  --results "$results" --seeds "$seeds" "${options[@]}" "${cases[@]}"
