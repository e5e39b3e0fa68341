#!/usr/bin/env bash
# Compares the speed of this package with others on the same images, on one thread, and prints the tables of docs/benchmarks/speed.md.
#
#   scripts/benchmark.sh [--stages] [FOLDER]
#   scripts/benchmark.sh --compare OLD_BUILD [--pairs N] [BAG ...]
#
# FOLDER: PNG images of one camera; without it EuRoC V1_01 of ../shared/data where that is there, else a simulated flight.
# --stages: Google Benchmark of every stage and kernel too, over sizes and numbers of lines.
# --compare: with another build of this package instead, a folder made by scripts/build.sh. Both track the same bags in turn, N
# times (15), so that a slower version shows on a machine that does other things too. BAG: to track; without any a simulated flight
# through a camera without distortion, one through EuRoC's, and EuRoC V1_01 where it is there.
set -euo pipefail
caller=$PWD
. "$(dirname "$0")/environment.sh"

stages=false
folder=
old=
pairs=15
bags=()
while [ $# -gt 0 ]; do
  case $1 in
    --stages) stages=true ;;
    --help | -h) printHelp && exit ;;
    --compare | --pairs)
      [ $# -gt 1 ] || fail "$1 needs a value; see --help"
      if [ "$1" = --compare ]; then old=$2; else pairs=$2; fi
      shift ;;
    -*) fail "unknown option $1; see --help" ;;
    *) bags+=("$(cd "$caller" && realpath -m "$1")") ;;
  esac
  shift
done
data=${TET_SHARED_DATA:-../shared/data}/euroc_v1_01/mav0
work=$build/benchmark
if [ -n "$old" ]; then
  old=$(cd "$caller" && realpath -m "$old")
  [ -x "$old/devel/lib/tet_line_tracker/track_bag" ] || fail "$old is no build of this package: it has no track_bag"
  [[ $pairs =~ ^[1-9][0-9]*$ ]] || fail "--pairs is $pairs, needs a number from 1 on"
  for bag in "${bags[@]}"; do [ -e "$bag" ] || fail "there is no bag $bag"; done
else
  [ ${#bags[@]} -le 1 ] || fail "takes one folder of images; see --help"
  folder=${bags[0]:-}
  [ -z "$folder" ] || [ -d "$folder" ] || fail "the folder of images cannot be opened; see --help"
  requirePackages "${packages_benchmark[@]}"
fi
scripts/build.sh
tools=$build/devel/lib/tet_line_tracker
mkdir -p "$work"

if [ -n "$old" ]; then
  sourceSetup "$build/devel/setup.bash"
  if [ ${#bags[@]} -eq 0 ]; then
    bags=("$work/pinhole.bag" "$work/lens.bag")
    writeLens "$work/pinhole.yaml" 752 480 458 376 240 plumb_bob "0, 0, 0, 0, 0"
    [ -e "$work/pinhole.bag" ] ||
      "$tools/simulate_bag" "$work/pinhole.bag" --seconds 10 --seed 1001 --camera-info "$work/pinhole.yaml"
    [ -e "$work/lens.bag" ] || "$tools/simulate_bag" "$work/lens.bag" --seconds 10 --seed 1001
    if [ -d "$data" ]; then
      [ -e "$work/euroc_v1_01.bag" ] || "$tools/dataset_to_bag" euroc "$data" "$work/euroc_v1_01.bag"
      bags+=("$work/euroc_v1_01.bag")
    fi
  fi
  exec python3 scripts/compare_speed.py "$old" "$build" "$pairs" "${bags[@]}"
fi

grep -q '^benchmark_DIR:.*-NOTFOUND' "$build/CMakeCache.txt" && cmake "$build" >/dev/null
cmake --build "$build" --target speed_comparison stage_benchmark >"$build/benchmark.log" || { cat "$build/benchmark.log" >&2; exit 1; }
sourceSetup "$build/devel/setup.bash"

if [ -z "$folder" ] && [ -d "$data/cam0/data" ]; then folder=$data/cam0/data; fi
"$tools/speed_comparison" ${folder:+"$folder"}

flight=$work/flight.bag
[ -e "$flight" ] || "$tools/simulate_bag" "$flight" --seconds 49.95 --seed 1001 >/dev/null
printf '\n## Memory of track_bag, 1000 images [MB resident]\n\n| | at 1/4 | at 1/2 | at 3/4 | at the end | peak |\n|---|---|---|---|---|---|\n'
python3 scripts/run_memory.py "default" "$tools/track_bag" "$flight" "$work/lines.bag"
python3 scripts/run_memory.py "LSD + LBD + KNN" "$tools/track_bag" "$flight" "$work/lines.bag" --tracker lsd_lbd_knn

if $stages; then "$tools/stage_benchmark"; fi
