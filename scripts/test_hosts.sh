#!/usr/bin/env bash
# Camera, tracker and estimator on three hosts, as network namespaces of this machine: compressed images go to the tracker and its
# lines to the estimator, through TCP. After a third of the time the network of the tracker is cut for 5 s. Fails when an image is
# lost before the cut, when lines do not come again after it, or when an id breaks its promise.
#
#   scripts/test_hosts.sh [SECONDS]
#
# SECONDS: of images at 20 Hz (45). Needs root.
set -euo pipefail
. "$(dirname "$0")/environment.sh"
answerHelp "$@"
seconds=${1:-45}
cut_after=$((seconds / 3))
cut_seconds=5

[ "$(id -u)" = 0 ] || fail "namespaces of the network need the rights of root: start it with sudo"
requirePackages "${packages_build[@]}" "${packages_run[@]}" "${packages_hosts[@]}"
scripts/build.sh
requireFlight
sourceSetup "$build/devel/setup.bash"
work=$build/hosts
mkdir -p "$work"

name=tet_$$
hosts=(camera tracker estimator)
removeNetwork() {
  stopChildren
  for host in switch "${hosts[@]}"; do ip netns delete "${name}_$host" 2>/dev/null || true; done
}
trap removeNetwork EXIT
trap 'exit 130' INT

# A bridge in a namespace of its own, so that nothing of this machine's network changes.
makeNetwork() {
  local i host
  ip netns add "${name}_switch" 2>"$work/network.log" || fail "no network namespace can be made here: $(cat "$work/network.log")"
  ip -n "${name}_switch" link add switch type bridge
  ip -n "${name}_switch" link set switch up
  for i in "${!hosts[@]}"; do
    host=${hosts[$i]}
    ip netns add "${name}_$host"
    ip -n "${name}_switch" link add "to_$host" type veth peer name network netns "${name}_$host"
    ip -n "${name}_switch" link set "to_$host" master switch up
    ip -n "${name}_$host" link set lo up
    ip -n "${name}_$host" link set network up
    ip -n "${name}_$host" address add "10.78.0.$((i + 1))/24" dev network
  done
}

# on HOST COMMAND ...: in the place of this shell, so that the command gets its signals.
on() {
  local i
  for i in "${!hosts[@]}"; do [ "${hosts[$i]}" != "$1" ] || break; done
  exec env -u ROS_HOSTNAME ROS_IP="10.78.0.$((i + 1))" ROS_MASTER_URI=http://10.78.0.1:11311 ip netns exec "${name}_$1" "${@:2}" </dev/null
}

rm -f "$work/playing" "$work/cut"
makeNetwork
on camera roscore >"$work/roscore.log" 2>&1 &
children+=($!)
tries=0
until (on camera rosnode list) >/dev/null 2>&1; do
  tries=$((tries + 1))
  [ $tries -lt 60 ] || { tail -n 5 "$work/roscore.log" >&2; fail "no master answers on the camera's host"; }
  sleep 0.5
done
on tracker roslaunch --wait tet_line_tracker pl_vins.launch image_transport:=compressed >"$work/tracker.log" 2>&1 &
children+=($!)
on estimator python3 scripts/watch_lines.py "$work/cut" >"$work/estimator.txt" 2>"$work/estimator.log" &
estimator=$!
children+=($estimator)
(
  while [ ! -e "$work/playing" ]; do sleep 0.1; done
  sleep "$cut_after"
  ip -n "${name}_switch" link set to_tracker nomaster
  sleep $cut_seconds
  ip -n "${name}_switch" link set to_tracker master switch
  touch "$work/cut"
) &
children+=($!)
(on camera python3 scripts/play_compressed.py "$flight" "$seconds" "$work/playing" >"$work/camera.txt" 2>"$work/camera.log") ||
  { tail -n 5 "$work"/*.log >&2; fail "the images were not played to their end"; }
sleep 3
kill -INT $estimator
status=0
wait $estimator || status=$?
cat "$work/camera.txt" "$work/estimator.txt"
[ $status = 0 ] || { tail -n 5 "$work/estimator.log" >&2; fail "the lines did not come as they should (build/hosts)"; }
