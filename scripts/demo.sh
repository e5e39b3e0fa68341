#!/usr/bin/env bash
# Builds if needed and shows lines being tracked in a simulated flight, which is rendered once and kept under build/.
#
#   scripts/demo.sh [--headless]
#
# In rviz where there is a display. --headless plays the flight once and ends with a summary of the tracks.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

headless=false
if [ -z "${DISPLAY:-}" ]; then headless=true; fi
for argument in "$@"; do
  case $argument in
    --headless) headless=true ;;
    --help | -h) sed -n '2,6s/^# \{0,1\}//p' scripts/demo.sh && exit ;;
    *) fail "unknown option $argument; see --help" ;;
  esac
done

packages=("${packages_build[@]}" "${packages_run[@]}")
if ! $headless; then packages+=("${packages_rviz[@]}"); fi
requireLocalhost
requirePackages "${packages[@]}"
scripts/build.sh
sourceSetup "$build/devel/setup.bash"
tools=$build/devel/lib/tet_line_tracker

requireFlight
demo=$build/demo

if ! $headless; then
  chooseMaster
  echo "To look at topics from another terminal (rostopic list, rosnode list, rosservice list):"
  echo "  . '$build/devel/setup.bash'; export ROS_HOSTNAME=$ROS_HOSTNAME ROS_MASTER_URI=$ROS_MASTER_URI"
  exec roslaunch -p "${ROS_MASTER_URI##*:}" tet_line_tracker demo.launch bag:="$flight"
fi

startMaster
tracks=$demo/tracks.bag
rm -f "$tracks" "$tracks.active"
rosrun rosbag record -q -O "$tracks" /line_tracker/lines >"$demo/record.log" 2>&1 &
recorder=$!
children+=("$recorder")
echo "Playing the flight through the node ..."
roslaunch --wait tet_line_tracker demo.launch bag:="$flight" rviz:=false </dev/null >"$demo/launch.log" 2>&1 ||
  { tail -n 30 "$demo/launch.log" >&2; fail "the node or the player ended with an error (build/demo/launch.log)"; }
kill -INT $recorder 2>/dev/null || true
wait $recorder || true
# roslaunch ends with 0 also when the player did not start.
if [ ! -e "$tracks" ] || ! "$tools/check_lines" "$tracks"; then
  tail -n 30 "$demo/launch.log" >&2
  fail "the node published no lines, or wrong ones (build/demo/launch.log)"
fi
"$tools/evaluate_tracks" "$tracks" | awk '
  NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i }
  NR == 2 { images = $column["images"]; lines = $column["lines"]; length_of_track = $column["length"] }
  END {
    printf "%s images, %s lines per image, mean track length %s images\n", images, lines, length_of_track
    exit !(images > 0 && lines > 0)
  }'

# The lines of the node over the images that it had.
"$tools/paint_tracks" "$tracks" "$demo/picture.png" --images "$flight" --number 100
echo "picture 100 with its lines: $demo/picture.png"
