#!/usr/bin/env bash
# Measures which lines of the core, the nodelets, the displays and the tools are run by the tests and prints a table by folder. Exit
# status 1 when a test fails, or when less is run than must be: 95 % of the lines of the core, 85 % of those of the rest.
#
#   scripts/coverage.sh [--core | --rest]
#
# The core is measured by its own tests, as sanitize.sh builds and runs them; the rest by test.sh in the usual build, from then on
# with counters (-DTET_COVERAGE=OFF builds without again). --core: the core alone. --rest: the rest alone, by what has run with
# counters before. Each line is shown in build/coverage/core.html and rest.html.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

parts=(core rest)
measured=false
case ${1:-} in
  --core) parts=(core) && shift ;;
  --rest) parts=(rest) measured=true && shift ;;
esac
answerHelp "$@"
if $measured && ! grep -qs '^TET_COVERAGE:BOOL=ON' "$build/CMakeCache.txt"; then
  fail "the build has no counters: start scripts/build.sh --tests -DTET_COVERAGE=ON and scripts/test.sh before"
fi
report=$build/coverage
mkdir -p "$report"
requirePackages "${packages_coverage[@]}"

runCore() {
  # A build of an earlier version has no counters.
  grep -qse --coverage "$sanitized/CMakeCache.txt" || rm -rf "$sanitized"
  mkdir -p "$sanitized"
  find "$sanitized" -name '*.gcda' -delete
  scripts/sanitize.sh
}
runRest() {
  scripts/build.sh --tests -DTET_COVERAGE=ON
  find "$build/src" -name '*.gcda' -delete
  scripts/test.sh --no-lint
}

# table PART OBJECTS LEAST: of the sources that PART names; exit status 1 when less than LEAST [%] of their lines ran.
table() {
  local filters=(--filter src/core/ --filter include/)
  if [ "$1" = rest ]; then filters=(--filter src/ros/ --filter src/rviz/ --filter src/tools/); fi
  # Counters that threads share may end below zero, which gcovr does not read. In one thread: with several, gcovr 5.2 waits forever
  # after an error in one of them.
  gcovr --gcov-ignore-parse-errors --root "$project" --object-directory "$2" "${filters[@]}" --csv "$report/$1.csv" --html-details "$report/$1.html" \
    "$2" >"$report/gcovr.log" 2>&1 </dev/null ||
    { tail -n 20 "$report/gcovr.log" >&2; fail "gcovr could not read the counters of $2"; }
  # Public headers count to the rooms of the core that they belong to.
  awk -F, -v sum="the $1" -v least="$3" '
    function row(name) { printf "%-26s %6d of %6d lines  %5.1f %%\n", name, run[name], all[name], 100 * run[name] / all[name] }
    NR == 1 { next }
    {
      folder = $1
      sub("^include/tet_line_tracker/", "src/core/", folder)
      sub("/[^/]*$", "", folder)
      if (!(folder in all)) names[++count] = folder
      all[folder] += $2; run[folder] += $3; all[sum] += $2; run[sum] += $3
    }
    END {
      for (i = 1; i <= count; ++i) row(names[i])
      row(sum)
      exit all[sum] == 0 || 100 * run[sum] < least * all[sum]
    }' "$report/$1.csv"
}

status=0
for part in "${parts[@]}"; do
  objects=$build/src least=85
  if [ $part = core ]; then objects=$sanitized least=95; fi
  if ! $measured; then "run${part^}" || status=1; fi
  table $part "$objects" $least || fail "the tests run too few lines of the $part: $least % are needed"
done
[ $status = 0 ] || fail "a test failed"
