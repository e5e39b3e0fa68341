#!/usr/bin/env bash
# Builds if needed and runs every test and check; the exit status and the last line say the result.
#
#   scripts/test.sh [--no-lint] [NAME]
#
# NAME, a regular expression, picks among the test programs of CTest.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

lint=lint
pick=()
for argument in "$@"; do
  case $argument in
    --no-lint) lint=no-lint ;;
    --help | -h) sed -n '2,6s/^# \{0,1\}//p' scripts/test.sh && exit ;;
    -*) fail "unknown option $argument; see --help" ;;
    *) pick=(-R "$argument") lint=no-lint ;;
  esac
done

packages=("${packages_build[@]}" "${packages_run[@]}" "${packages_test[@]}")
if [ $lint = lint ]; then packages+=("${packages_lint[@]}"); fi
requireLocalhost
requirePackages "${packages[@]}"
scripts/build.sh --tests
sourceSetup "$build/devel/setup.bash"

rm -rf "$build/test_results"
status=0
# Those with nodes run alone, on a master with a free port.
(cd "$build" && ctest -j"$(nproc)" --timeout 600 --output-on-failure "${pick[@]}" </dev/null) || status=1
if [ $lint = lint ]; then python3 scripts/lint.py "$build" || status=1; fi
python3 scripts/count_tests.py "$build" $lint "${pick[@]}" || status=1
exit $status
