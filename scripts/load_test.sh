#!/usr/bin/env bash
# Puts the tracker under load and prints a table: latency from an image to its lines, processor, memory, images lost, debug images seen.
#
#   scripts/load_test.sh [SECONDS]
#
# SECONDS: of each row (60). Cameras and trackers in one process, which shares the images, and then with the trackers in a
# nodelet manager of their own behind TCP. Nothing else should run on the machine.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

answerHelp "$@"
seconds=${1:-60}
requireLocalhost
requirePackages "${packages_build[@]}" "${packages_run[@]}"
scripts/build.sh
cmake --build "$build" --target load_generator >"$build/load.log"
sourceSetup "$build/devel/setup.bash"
startMaster

# row OPTIONS...: in one process, and over TCP.
row() {
  "$build/devel/lib/tet_line_tracker/load_generator" --seconds "$seconds" "$@" 2>>"$build/load.log" </dev/null | grep '^|'
  rosrun nodelet nodelet manager __name:=manager >>"$build/load.log" 2>&1 </dev/null &
  local manager=$!
  children+=("$manager")
  "$build/devel/lib/tet_line_tracker/load_generator" --seconds "$seconds" --manager-pid "$manager" "$@" 2>>"$build/load.log" \
    </dev/null | grep '^|'
  kill -INT "$manager"
  wait "$manager" || true
}
echo "| load | transport | images | p50 [ms] | p99 [ms] | max [ms] | processor [% of a core] | memory [MB] | lost | debug images |"
echo "|---|---|---|---|---|---|---|---|---|---|"
row --label "752x480 at 200 Hz" --rate 200
row --label "752x480 at 200 Hz, debug image and markers watched" --rate 200 --watch
row --label "four cameras, 752x480 at 60 Hz" --cameras 4 --rate 60
row --label "1920x1080 at 60 Hz" --rate 60 --width 1920 --height 1080
row --label "752x480 at 60 Hz, after 5 s at 600 Hz" --rate 60 --flood 5
