# Which seeds a script may use; sourced, after environment.sh. `tuning`, true or false, is what the script was asked for.
#
# Seeds from 1000 on are kept for tables in docs: what was tuned on a flight says nothing about other flights. Tuning uses seeds
# below 1000 and the option --tuning, and its tables say so.

# The seed of a script that is given none; the first, where it uses several.
defaultSeed() { if $tuning; then echo 1; else echo 1001; fi; }

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
