#!/usr/bin/env bash
# Mutation testing of the core, the bridge and the readers: changes one line at a time and sees which test notices. Exit
# status 1 when a mutation survives all tests.
#
#   scripts/mutate.sh [--list] [NUMBER ...]
#
# NUMBER: of mutations, as --list gives them; none: all. They are the blocks of scripts/mutations.txt, and are made in a
# copy of the source folder, build/mutants/source.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

for argument in "$@"; do
  case $argument in
    --help | -h) sed -n '2,8s/^# \{0,1\}//p' scripts/mutate.sh && exit ;;
    --list) exec python3 scripts/mutate.py --list ;;
    *[!0-9]*) fail "unknown option $argument; see --help" ;;
  esac
done

requirePackages "${packages_build[@]}" "${packages_test[@]}"
exec python3 scripts/mutate.py "$build/mutants" "$@"
