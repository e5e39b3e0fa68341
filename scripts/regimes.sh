# The simulated regimes by name, as options of simulate_bag. Sourced.
# shellcheck disable=SC2034
declare -A flights=(
  [slow]="--motion slow" [fast]="--motion fast" [corridor]="--motion corridor" [low]="--motion slow --light low"
  [gain]="--motion slow --light gain_jumps" [shake]="--motion shake" [rotation]="--motion rotation"
  [moving]="--motion slow --moving-object" [all]="--motion fast --light low,gain_jumps" [still]="--motion still"
  [street]="--motion drive")
