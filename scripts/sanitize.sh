#!/usr/bin/env bash
# Builds tests with sanitizers and runs them; a test that fails and anything that a sanitizer finds is an error.
#
#   scripts/sanitize.sh [--ros | --tools | --thread] [TEST ...]
#
# AddressSanitizer and UndefinedBehaviorSanitizer over the tests of the core, with --ros over those of test/ros with the managers of
# their nodelets, or with --tools over those of the tools, the simulation, the judges and the displays. --thread: ThreadSanitizer
# over what runs in several threads. TEST: names of test programs; none: all of the core (but that of the installed package, which
# runs a compiler), of test/ros, of the folders of --tools, or those with threads.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

part=core
case ${1:-} in
  --ros | --tools | --thread) part=${1#--} && shift ;;
esac
answerHelp "$@"
tests=("$@")
if [ ${#tests[@]} -eq 0 ]; then
  case $part in
    core) mapfile -t tests < <(basename -s .cpp test/core/*/*_test.cpp | grep -v core_package_test) ;;
    # Launch files of the package and programs start programs of the build without sanitizers.
    ros) mapfile -t tests < <(basename -s .cpp test/ros/*_test.cpp | grep -v -e check_plvins_contract_live_test -e euroc_launch_test -e line_subscriber_test) ;;
    tools) mapfile -t tests < <(basename -s .cpp test/{tools,simulation,evaluation,rviz}/*_test.cpp) ;;
    thread) tests=(line_tracker_test newest_queue_test sensor_input_test silence_warning_test debug_image_publisher_test master_loss_test
      line_mapper_nodelet_test pl_vins_bridge_test reconfigure_test sim_time_test nodelet_life_test nodelet_test) ;;
  esac
fi

runtime=libasan.so
if [ $part = thread ]; then
  sanitizers=thread
  runtime=libtsan.so
fi
targets=("${tests[@]}")
if [ $part != core ]; then targets+=(tet_line_tracker_nodelets line_tracker); fi
buildSanitized "${targets[@]}"

reports=$sanitized/reports
rm -rf "$reports"
mkdir -p "$reports"
if [ $part != core ]; then
  requirePackages "${packages_run[@]}" "${packages_test[@]}"
  requireLocalhost
  sourceSetup "$sanitized/devel/setup.bash"
  # The manager is not built here: it needs the runtime before everything else. Python and roslaunch go without.
  TET_MANAGER_PREFIX="env LD_PRELOAD=$(gcc -print-file-name=$runtime)"
  # Leaks are those of the class loader and of log4cxx at the end; soak.sh watches the memory of the node.
  ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:log_path=$reports/address
  UBSAN_OPTIONS=print_stacktrace=1:log_path=$reports/undefined
  if [ $part = thread ]; then
    # The runtime of GCC does not know the layout of addresses of newer kernels.
    TET_MANAGER_PREFIX+=" setarch -R"
    TSAN_OPTIONS="suppressions=$project/scripts/thread_sanitizer.supp history_size=7 exitcode=0 log_path=$reports/thread"
    export TSAN_OPTIONS
  fi
  export TET_MANAGER_PREFIX
fi

status=0
if [ $part = thread ]; then export TET_TEST_PREFIX="setarch -R"; fi
export programs=$sanitized/devel/lib/tet_line_tracker reports
# One that needs no master.
runProgram() {
  local status=0 begin=$SECONDS
  ${TET_TEST_PREFIX:-} "$programs/$1" --gtest_brief=1 >"$reports/$1.txt" 2>&1 </dev/null || status=$?
  if [ $status != 0 ]; then tail -n 200 "$reports/$1.txt"; fi
  echo "$1: $(grep -h '^\[==========\]' "$reports/$1.txt" | tail -n 1 | cut -c 14-), status $status, $((SECONDS - begin)) s"
  return $status
}
export -f runProgram
with_master=() alone=()
for test in "${tests[@]}"; do
  if [ -e "test/ros/$test.test" ]; then with_master+=("$test"); else alone+=("$test"); fi
done
if [ ${#alone[@]} -gt 0 ]; then
  printf '%s\n' "${alone[@]}" | xargs -P "$(nproc)" -I{} bash -c 'runProgram {}' || status=1
fi
for test in "${with_master[@]}"; do
  echo "$test ..."
  rostest --pkgdir="$project" --package=tet_line_tracker --results-base-dir="$sanitized/test_results" "test/ros/$test.test" \
    >"$reports/$test.txt" 2>&1 </dev/null || { tail -n 40 "$reports/$test.txt"; status=1; }
done
python3 scripts/sanitizer_reports.py "$reports" "$sanitized" || status=1
[ $status = 0 ] || fail "a test failed or a sanitizer found something"
echo "sanitizers: ${#tests[@]} test programs, nothing found"
