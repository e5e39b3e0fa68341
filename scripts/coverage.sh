#!/usr/bin/env bash
# Measures which lines of the sources are run by the tests and prints a table by folder. Exit status 1 when a test fails, or when
# less is run than must be: 95 % of the lines of the core, 85 % of those of the rest.
#
#   scripts/coverage.sh [--core]
#
# --core: the core alone, by its own tests as sanitize.sh builds and runs them. Else everything, in a build of its own. Each line is
# shown in build/coverage/index.html.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

part=all
if [ "${1:-}" = --core ]; then part=core && shift; fi
answerHelp "$@"
report=$build/coverage
mkdir -p "$report"
requirePackages "${packages_coverage[@]}"

status=0
if [ $part = core ]; then
  # A build of an earlier version has no counters.
  grep -qse --coverage "$sanitized/CMakeCache.txt" || rm -rf "$sanitized"
  mkdir -p "$sanitized"
  find "$sanitized" -name '*.gcda' -delete
  scripts/sanitize.sh || status=1
else
  requirePackages "${packages_run[@]}"
  requireLocalhost
  # Tests of scripts use the programs of the usual build.
  scripts/build.sh --tests
  sanitizers=coverage
  buildSanitized all tests
  find "$sanitized" -name '*.gcda' -delete
  sourceSetup "$sanitized/devel/setup.bash"
  (cd "$sanitized" && ctest -j"$(nproc)" --timeout 900 --output-on-failure </dev/null) || status=1
fi

gcovr --root "$project" --object-directory "$sanitized" --filter src/ --filter include/ -j "$(nproc)" --csv "$report/lines.csv" \
  --html-details "$report/index.html" "$sanitized" >"$report/gcovr.log" 2>&1 ||
  { tail -n 20 "$report/gcovr.log" >&2; fail "gcovr could not read the counters of $sanitized"; }
# Public headers count to the rooms of the core that they belong to.
awk -F, -v part=$part '
  function row(name) { printf "%-26s %6d of %6d lines  %5.1f %%\n", name, run[name], all[name], 100 * run[name] / all[name] }
  NR == 1 { next }
  {
    folder = $1
    sub("^include/tet_line_tracker/", "src/core/", folder)
    sub("/[^/]*$", "", folder)
    sum = folder ~ "^src/core" ? "the core" : "the rest"
    if (part == "core" && sum == "the rest") next
    if (!(folder in all)) names[++count] = folder
    all[folder] += $2; run[folder] += $3; all[sum] += $2; run[sum] += $3
  }
  END {
    for (i = 1; i <= count; ++i) row(names[i])
    row("the core")
    if ("the rest" in all) row("the rest")
    exit run["the core"] < 0.95 * all["the core"] || ("the rest" in all && run["the rest"] < 0.85 * all["the rest"])
  }' "$report/lines.csv" || fail "the tests run too few lines: 95 % of the core and 85 % of the rest are needed"
[ $status = 0 ] || fail "a test failed"
