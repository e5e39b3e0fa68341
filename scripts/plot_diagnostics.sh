#!/usr/bin/env bash
# Flies a simulated flight through the node and draws what it reports on /diagnostics: the figure of docs/diagnostics.md.
#
#   scripts/plot_diagnostics.sh [OUT.png [SECONDS]]
#
# OUT.png: docs/images/diagnostics.png. SECONDS of the flight, which are those of the wall clock too: 40.
set -euo pipefail
case ${1:-} in
  --help | -h) sed -n '2,6s/^# \{0,1\}//p' "$0" && exit ;;
esac
picture=$(realpath -m "${1:-$(dirname "$0")/../docs/images/diagnostics.png}")
seconds=${2:-40}
. "$(dirname "$0")/environment.sh"

requireLocalhost
requirePackages "${packages_build[@]}" "${packages_run[@]}" "${packages_plot[@]}"
scripts/build.sh
sourceSetup "$build/devel/setup.bash"
tools=$build/devel/lib/tet_line_tracker
folder=$build/diagnostics
mkdir -p "$folder"
if [ ! -e "$folder/flight_$seconds.bag" ]; then
  echo "Simulating a flight of $seconds s, once ..."
  "$tools/simulate_bag" "$folder/flight_$seconds.bag" --seed 1001 --seconds "$seconds"
fi

startMaster
until rosparam set use_sim_time true 2>/dev/null; do sleep 0.2; done
"$tools/line_tracker" image:=/cam0/image_raw camera_info:=/cam0/camera_info imu:=/imu0 >"$folder/node.log" 2>&1 &
children+=($!)
rosrun rosbag record -q -O "$folder/diagnostics.bag" /diagnostics >"$folder/record.log" 2>&1 &
recorder=$!
children+=("$recorder")
echo "Playing it through the node ..."
# The clock in steps of 1 ms, so that latencies are told to 1 ms.
rosrun rosbag play --quiet --clock --hz 1000 --wait-for-subscribers "$folder/flight_$seconds.bag" \
  --topics /cam0/image_raw /cam0/camera_info /imu0 /tf /tf_static </dev/null >"$folder/player.log" 2>&1 ||
  fail "the player ended with an error (build/diagnostics/player.log)"
kill -INT "$recorder"
wait "$recorder" || true
[ -e "$folder/diagnostics.bag" ] || fail "nothing was recorded (build/diagnostics/record.log)"
mkdir -p "$(dirname "$picture")"
python3 scripts/plot_diagnostics.py "$folder/diagnostics.bag" "$picture"
echo "$picture"
