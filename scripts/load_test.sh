#!/usr/bin/env bash
# Puts the tracker under load and prints a table: latency from an image to its lines, processor, memory, images lost, debug images seen.
#
#   scripts/load_test.sh [SECONDS]
#
# SECONDS: of each row (60). Cameras and trackers in one process, which shares the images, and then with the trackers in a
# nodelet manager of their own behind TCP; those of four cameras from multi_camera.launch. Nothing else should run on the machine.
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

generate() {
  "$build/devel/lib/tet_line_tracker/load_generator" --seconds "$seconds" "$@" 2>>"$build/load.log" </dev/null | grep '^|'
}
# In the background, with its process in `started`.
start() {
  "$@" >>"$build/load.log" 2>&1 </dev/null &
  started=$!
  children+=("$started")
}
end() {
  kill -INT "$1" 2>/dev/null || true
  wait "$1" || true
}
# For four cameras, whose trackers multi_camera.launch loads into /manager.
generateForLaunched() {
  local trackers
  start roslaunch tet_line_tracker multi_camera.launch cameras:="launched0 launched1 launched2 launched3" image:=image imu:=/imu \
    manager:=/manager start_manager:=false
  trackers=$started
  generate --cameras 4 --launched "$@"
  end "$trackers"
}

# row GENERATE OPTIONS...: in one process, and over TCP.
row() {
  local generate=$1 manager
  shift
  $generate "$@" __name:=manager
  start rosrun nodelet nodelet manager __name:=manager
  manager=$started
  $generate --manager-pid "$manager" "$@"
  end "$manager"
}
echo "| load | transport | images | p50 [ms] | p99 [ms] | max [ms] | processor [% of a core] | memory [MB] | lost | debug images |"
echo "|---|---|---|---|---|---|---|---|---|---|"
row generate --label "752x480 at 200 Hz" --rate 200
row generate --label "752x480 at 200 Hz, debug image and markers watched" --rate 200 --watch
row generateForLaunched --label "four cameras, 752x480 at 60 Hz" --rate 60
row generate --label "1920x1080 at 60 Hz" --rate 60 --width 1920 --height 1080
row generate --label "752x480 at 60 Hz, after 5 s at 600 Hz" --rate 60 --flood 5
