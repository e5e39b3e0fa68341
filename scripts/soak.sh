#!/usr/bin/env bash
# Runs the node on a flight that is played again and again, and fails when its memory grows, an id comes back after it was
# missing, or its lines stop.
#
#   scripts/soak.sh [MINUTES [RATE]]
#
# MINUTES: 30. RATE: times real time, which is 20 images per second (2): 100 000 images are 42 minutes at 2 and 9 at 10.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

answerHelp "$@"
requireLocalhost
requirePackages "${packages_build[@]}" "${packages_run[@]}"
scripts/build.sh
sourceSetup "$build/devel/setup.bash"
requireFlight

startMaster
"$build/devel/lib/tet_line_tracker/line_tracker" image:=/cam0/image_raw camera_info:=/cam0/camera_info \
  >"$build/soak.log" 2>&1 &
node=$!
# The stamps jump back at every turn: each is an epoch of its own.
rosrun rosbag play --quiet --loop --rate "${2:-2}" "$flight" >"$build/soak_player.log" 2>&1 &
children+=("$node" $!)
python3 scripts/watch_node.py "$node" "${1:-30}" </dev/null
