#!/usr/bin/env bash
# Builds the tests of the core with AddressSanitizer and UndefinedBehaviorSanitizer in build/sanitized and runs them.
#
#   scripts/sanitize.sh [TEST ...]
#
# TEST: names of test programs of the core; none: all in test/core but that of the installed package, which runs a compiler.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

answerHelp "$@"
tests=("$@")
if [ ${#tests[@]} -eq 0 ]; then mapfile -t tests < <(basename -s .cpp test/core/*/*.cpp | grep -v core_package_test); fi
buildSanitized "${tests[@]}"
for test in "${tests[@]}"; do
  echo "$test ..."
  "$sanitized/devel/lib/tet_line_tracker/$test" --gtest_brief=1 </dev/null
done
echo "sanitizers: ${#tests[@]} test programs, nothing found"
