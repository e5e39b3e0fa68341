#!/usr/bin/env bash
# Tries the package in new roots of Debian, one after the other, as on a new machine: the commands of README and docs/ as they are
# written, from `git clone` on; all tests; the installed package with its source moved away. Prints a row for each.
#
#   scripts/test_distributions.sh [--keep-going] [SUITE ...]
#
# SUITE: of Debian (bullseye bookworm trixie). Takes what is committed. Each needs root, 3 GB for a while and the better part of an
# hour on two processors. What was said is in build/distributions/SUITE, of the commands in its folder commands. --keep-going: go on with the next where one fails.
set -euo pipefail
. "$(dirname "$0")/environment.sh"
. scripts/fresh_root.sh

keep_going=false
suites=()
for argument in "$@"; do
  case $argument in
    --help | -h) printHelp && exit ;;
    --keep-going) keep_going=true ;;
    -*) fail "unknown option $argument; see --help" ;;
    *) suites+=("$argument") ;;
  esac
done
data=$(realpath -m "${TET_SHARED_DATA:-../shared/data}")
if [ ${#suites[@]} -eq 0 ]; then suites=(bullseye bookworm trixie); fi

# inClone COMMAND ...: in the clone that the commands of README made.
inClone() { inFreshRoot env TET_SHARED_DATA=/srv/shared/data sh -c 'cd /srv/docs/tet_line_tracker && exec "$@"' sh "$@"; }

# step SUITE NAME COMMAND ...: the last line of what it says, or where all of it is.
step() {
  local log=$logs/$2.log status=ok
  "${@:3}" >"$log" 2>&1 || status=FAILED
  printf '%-9s %-8s %-7s %s\n' "$1" "$2" "$status" "$(tail -n 1 "$log" | cut -c 1-100)"
  [ $status = ok ] || failed=true
}

trySuite() (
  failed=false
  logs=$build/distributions/$1
  mkdir -p "$logs"
  makeFreshRoot "$1" >"$logs/root.log"
  mkdir -p "$fresh_root/dev/shm"
  mount -t tmpfs tmpfs "$fresh_root/dev/shm" || true
  inFreshRoot sh -c 'apt-get update && apt-get install -y --no-install-recommends git ca-certificates python3' >>"$logs/root.log" 2>&1
  git clone -q --no-hardlinks "$project" "$fresh_root/srv/source"
  if [ -d "$data" ]; then mkdir "$fresh_root/srv/shared" && cp -r "$data" "$fresh_root/srv/shared/data"; fi
  step "$1" docs inFreshRoot python3 /srv/source/scripts/check_docs.py --clone /srv/docs
  mkdir -p "$logs/commands" && cp "$fresh_root"/srv/docs/*.log "$logs/commands" || true
  step "$1" tests inClone scripts/test.sh --no-lint
  step "$1" install inClone scripts/test_install.sh --move-source
  printf '%-9s %s\n' "$1" "$(inFreshRoot sh -c 'g++ --version | head -n 1; pkg-config --modversion opencv4 | sed "s/^/OpenCV /"' | paste -sd,)"
  ! $failed
)

status=0
for suite in "${suites[@]}"; do
  trySuite "$suite" || { status=1; $keep_going || break; }
done
exit $status
