# What the scripts that measure on simulated flights start with; sourced, with the arguments of the script.
#
# Seeds from 1000 on are kept for tables in docs: what was tuned on a flight says nothing about other flights. Tuning uses seeds
# below 1000 and the option --tuning, and its tables say so.
#
# Leaves `results`, the folder of the first argument, and `arguments`, those behind it.
caller=$PWD
. "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

tuning=false
arguments=()
for argument in "$@"; do
  case $argument in
    --help | -h) printHelp && exit ;;
    --tuning) tuning=true ;;
    -*) fail "unknown option $argument; see --help" ;;
    *) arguments+=("$argument") ;;
  esac
done
[ ${#arguments[@]} -gt 0 ] || fail "needs RESULTS; see --help"
results=$(cd "$caller" && realpath -m "${arguments[0]}")
arguments=("${arguments[@]:1}")

# The seeds of a script that is given none.
defaultSeeds() { if $tuning; then echo 1; else echo 1001; fi; }

# requireSeeds SEED...: ends the script when one is on the wrong side.
requireSeeds() {
  local seed
  for seed in "$@"; do
    [[ $seed =~ ^[0-9]{1,9}$ ]] || fail "'$seed' is no seed; see --help"
    if $tuning; then
      [ "$seed" -lt 1000 ] || fail "seed $seed is kept for tables in docs: seeds for --tuning are below 1000"
    else
      [ "$seed" -ge 1000 ] || fail "seed $seed is for --tuning: tables in docs are of seeds from 1000 on"
    fi
  done
}

# heading WORDS: of a table.
heading() {
  echo "== $*"
  if $tuning; then echo "TUNING: seeds below 1000, not for docs"; fi
}

# Makes RESULTS, builds, and leaves the folder of the programs in `tools`.
prepareTools() {
  mkdir -p "$results"
  scripts/build.sh
  sourceSetup "$build/devel/setup.bash"
  tools=$build/devel/lib/tet_line_tracker
}

# simulate FLIGHT SEED OPTIONS...: renders a flight, once. One that is there must have been made with the same options.
simulate() {
  requireSeeds "$2"
  local made=${1%.bag}.options options=(--seed "$2" "${@:3}")
  if [ -e "$1" ] && [ -e "$made" ]; then
    [ "$(cat "$made")" = "${options[*]}" ] || fail "$1 was made with $(cat "$made"), not ${options[*]}: take another RESULTS"
    return
  fi
  "$tools/simulate_bag" "$1" "${options[@]}" </dev/null
  echo "${options[*]}" >"$made"
}
