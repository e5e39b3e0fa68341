# The simulated regimes by name, as options of simulate_bag. Sourced.
# shellcheck disable=SC2034
declare -A flights=(
  [slow]="--motion slow" [fast]="--motion fast" [corridor]="--motion corridor" [low]="--motion slow --light low"
  [gain]="--motion slow --light gain_jumps" [shake]="--motion shake" [rotation]="--motion rotation"
  [moving]="--motion slow --moving-object" [all]="--motion fast --light low,gain_jumps" [still]="--motion still"
  [street]="--motion drive")
# Faults of an IMU by name, likewise.
# shellcheck disable=SC2034
declare -A bad_imus=(
  [imu_late]="--imu-time-offset 0.03" [imu_biased]="--imu-bias 0.2" [imu_turned]="--imu-misalignment 2"
  [imu_bad]="--imu-time-offset 0.03 --imu-bias 0.2 --imu-misalignment 2")
