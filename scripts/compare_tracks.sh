#!/usr/bin/env bash
# Tracks the same bags with two builds of the package and compares the lines: a change that must not change what is tracked gives
# the same hash in every row. Exit status 1 when one differs.
#
#   scripts/compare_tracks.sh OLD_BUILD NEW_BUILD RESULTS [SECONDS]
#
# OLD_BUILD, NEW_BUILD: folders made by scripts/build.sh. RESULTS: folder for the bags; sequences that are there are used again.
# SECONDS: of a simulated flight (6). The sequences are every simulated regime and, where they are, the extracts in ../shared/data
# (or TET_SHARED_DATA), each by method joint and method paper.
set -euo pipefail
case ${1:-} in
  --help | -h | "") sed -n '2,9s/^# \{0,1\}//p' "$0" && exit ;;
esac
[ $# -ge 3 ] || { echo "compare_tracks.sh: needs OLD_BUILD NEW_BUILD RESULTS; see --help" >&2; exit 2; }
old=$(realpath -e "$1")
new=$(realpath -e "$2")
mkdir -p "$3"
results=$(cd "$3" && pwd)
seconds=${4:-6}
. "$(dirname "$0")/environment.sh"
. scripts/regimes.sh
sourceSetup "$new/devel/setup.bash"

# tool BUILD NAME ARGUMENTS...: runs a tool with the libraries of its build.
tool() { LD_LIBRARY_PATH=$1/devel/lib:${LD_LIBRARY_PATH:-} "$1/devel/lib/tet_line_tracker/$2" "${@:3}"; }
for regime in "${!flights[@]}"; do
  # The regime's words are options.
  # shellcheck disable=SC2086
  [ -e "$results/$regime.bag" ] || tool "$new" simulate_bag "$results/$regime.bag" ${flights[$regime]} --seconds "$seconds"
done
data=${TET_SHARED_DATA:-../shared/data}
extracts=("euroc euroc_v1_01/mav0" "icl_nuim icl_nuim_of_kt0" "tum tum_fr3_structure_notexture_far" "kitti kitti_00")
for extract in "${extracts[@]}"; do
  read -r format folder <<<"$extract"
  if [ ! -e "$data/$folder" ]; then
    echo "skipped: $data/$folder is not there"
  elif [ ! -e "$results/$format.bag" ]; then
    tool "$new" dataset_to_bag "$format" "$data/$folder" "$results/$format.bag"
  fi
done

status=0
printf '%-10s %-7s %-16s %-16s\n' sequence method old new
for bag in "$results"/*.bag; do
  for method in joint paper; do
    hashes=()
    for version in "$old" "$new"; do
      lines=$results/lines.bag.tmp
      tool "$version" track_bag "$bag" "$lines" --set method=$method >"$results/track_bag.log" 2>&1 ||
        fail "track_bag of $version failed: $(tail -n 1 "$results/track_bag.log")"
      hashes+=("$(python3 scripts/hash_lines.py "$lines")")
      rm "$lines"
    done
    verdict=same
    [ "${hashes[0]}" = "${hashes[1]}" ] || { verdict=DIFFERENT; status=1; }
    printf '%-10s %-7s %-16s %-16s %s\n' "$(basename "$bag" .bag)" $method "${hashes[@]}" $verdict
  done
done
exit $status
