# What the scripts that measure on simulated flights start with; sourced, with the arguments of the script.
#
# Leaves `results`, the folder of the first argument, and `arguments`, those behind it.
caller=$PWD
. "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
. scripts/seeds.sh

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

# takeSeedAndSeconds SECONDS: sets `seed` and `seconds` from the arguments behind RESULTS; SECONDS where none are given.
takeSeedAndSeconds() {
  seed=${arguments[0]:-$(defaultSeed)}
  seconds=${arguments[1]:-$1}
  requireSeeds "$seed"
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

# trackWith JUDGE OPTION VALUES...: slow and fast flights with each value of an option of simulate_bag, for `seeds` and `seconds`,
# tracked by tet and lsd_lbd_knn. JUDGE: option of evaluate_tracks, whose tables are printed and left in TRACKER.csv.
trackWith() {
  local tracker motion value seed flight lines tracked
  for tracker in tet lsd_lbd_knn; do
    tracked=()
    for motion in slow fast; do
      for value in "${@:3}"; do
        for seed in "${seeds[@]}"; do
          flight=$results/$motion-$value-$seed.bag
          simulate "$flight" "$seed" --motion $motion "$2" "$value" --seconds "$seconds"
          lines=${flight%.bag}-$tracker.bag
          "$tools/track_bag" "$flight" "$lines" --tracker $tracker >"${lines%.bag}.txt"
          tracked+=("$lines")
        done
      done
    done
    heading "$tracker"
    "$tools/evaluate_tracks" "$1" --csv "$results/$tracker.csv" "${tracked[@]}"
  done
}
