#!/usr/bin/env bash
# Holds the bridge to PL-VINS against the estimator's contract on a bad day: tracker and bridge follow a simulated flight
# at 20 Hz behind points at 10 Hz, while images are dropped and late and the tracker is reset twice.
#
#   scripts/check_contract.sh [SECONDS [SEED]]
#
# SECONDS: of the flight (60). SEED: of what happens to the images (1). Fails when a rule is broken or a point message
# has no partner.
set -euo pipefail
case ${1:-} in
  --help | -h) sed -n '2,8s/^# \{0,1\}//p' "$0" && exit ;;
esac
seconds=${1:-60}
seed=${2:-1}
. "$(dirname "$0")/environment.sh"

requireLocalhost
requirePackages "${packages_build[@]}" "${packages_run[@]}"
scripts/build.sh
sourceSetup "$build/devel/setup.bash"
tools=$build/devel/lib/tet_line_tracker
work=$build/contract
mkdir -p "$work"
contract_flight=$work/flight_${seconds}s.bag
[ -e "$contract_flight" ] || "$tools/simulate_bag" "$contract_flight" --seconds "$seconds" --no-imu

startMaster
roslaunch --wait tet_line_tracker pl_vins.launch </dev/null >"$work/launch.log" 2>&1 &
children+=($!)
"$tools/check_plvins_contract" >"$work/verdict.txt" 2>"$work/checker.log" </dev/null &
checker=$!
children+=($checker)
python3 scripts/play_with_faults.py "$contract_flight" "$seed" </dev/null >"$work/played.txt" ||
  { tail -n 30 "$work/launch.log" >&2; fail "the flight was not played to its end"; }

kill -INT $checker
status=0
wait $checker || status=$?
cat "$work/played.txt" "$work/verdict.txt"
[ $status = 0 ] || fail "the contract is broken (build/contract/checker.log, launch.log)"
asked=$(sed -n 's/.* \([0-9]*\) point messages$/\1/p' "$work/played.txt")
grep -q "^$asked pairs of messages" "$work/verdict.txt" || fail "there were $asked point messages, and not as many pairs"
