#!/usr/bin/env bash
# Compares the speed of this package with others on the same images, on one thread, and prints the tables of docs/benchmarks/speed.md.
#
#   scripts/benchmark.sh [--stages] [FOLDER]
#
# FOLDER: PNG images of one camera; without it EuRoC V1_01 of ../shared/data where that is there, else a simulated flight.
# --stages: Google Benchmark of every stage and kernel too, over sizes and numbers of lines.
set -euo pipefail
stages=false
folder=
for argument in "$@"; do
  case $argument in
    --stages) stages=true ;;
    --help | -h) sed -n '2,7s/^# \{0,1\}//p' "$0" && exit ;;
    -*) echo "benchmark.sh: unknown option $argument; see --help" >&2 && exit 1 ;;
    *) folder=$argument ;;
  esac
done
if [ -n "$folder" ] && ! folder=$(cd "$folder" 2>/dev/null && pwd); then
  echo "benchmark.sh: the folder of images cannot be opened; see --help" >&2 && exit 1
fi
. "$(dirname "$0")/environment.sh"

requirePackages "${packages_benchmark[@]}"
scripts/build.sh
grep -q '^benchmark_DIR:.*-NOTFOUND' "$build/CMakeCache.txt" && cmake "$build" >/dev/null
cmake --build "$build" --target speed_comparison stage_benchmark >"$build/benchmark.log" || { cat "$build/benchmark.log" >&2; exit 1; }
sourceSetup "$build/devel/setup.bash"
tools=$build/devel/lib/tet_line_tracker

shared=${TET_SHARED_DATA:-$project/../shared/data}/euroc_v1_01/mav0/cam0/data
if [ -z "$folder" ] && [ -d "$shared" ]; then folder=$shared; fi
"$tools/speed_comparison" ${folder:+"$folder"}

flight=$build/benchmark/flight.bag
mkdir -p "$build/benchmark"
[ -e "$flight" ] || "$tools/simulate_bag" "$flight" --seconds 49.95 >/dev/null
printf '\n## Memory of track_bag, 1000 images [MB resident]\n\n| | at 1/4 | at 1/2 | at 3/4 | at the end | peak |\n|---|---|---|---|---|---|\n'
python3 scripts/run_memory.py "default" "$tools/track_bag" "$flight" "$build/benchmark/lines.bag"
python3 scripts/run_memory.py "LSD + LBD + KNN" "$tools/track_bag" "$flight" "$build/benchmark/lines.bag" --tracker lsd_lbd_knn

if $stages; then "$tools/stage_benchmark"; fi
