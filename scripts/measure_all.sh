#!/usr/bin/env bash
# Measures everything that the docs give figures of, one step after the other, and says which page each result goes to.
#
#   scripts/measure_all.sh RESULTS [--short] [STEP ...]
#
# RESULTS: folder for bags and tables. A step that is done is not done again: after an interruption, start the same command
# again; results of another commit are refused. STEP: only these, of tracking, tracking_3, priors, still, motion, lens, effects,
# distractors, methods, real, map, paper, speed, contract and vio (a step where TET_PL_VINS names a checkout of PL-VINS). --short: flights of 2 s,
# to try the command; speed takes as long as ever. All of it takes in the order of an hour on two processors, vio as long again; the
# list at the end has the minutes of each step. The times of methods, speed, paper and vio count only where nothing else runs.
set -euo pipefail
short=false
for argument in "$@"; do
  shift
  case $argument in
    --short) short=true ;;
    *) set -- "$@" "$argument" ;;
  esac
done
. "$(dirname "$0")/measuring.sh"
if $tuning; then fail "tables of docs are not for --tuning"; fi

version=$(git describe --always --dirty --abbrev=12 2>/dev/null || echo unknown)
if $short; then version+=", short"; fi
mkdir -p "$results"
[ -e "$results/version" ] || echo "$version" >"$results/version"
[ "$(cat "$results/version")" = "$version" ] ||
  fail "$results has results of $(cat "$results/version"), this is $version: take another RESULTS"

# seconds FULL: of a flight.
seconds() { if $short; then echo 2; else echo "$1"; fi; }
data=$(realpath -m "${TET_SHARED_DATA:-../shared/data}")
datasets=()
for dataset in euroc:euroc_v1_01/mav0 icl_nuim:icl_nuim_of_kt0 tum:tum_fr3_structure_notexture_far kitti:kitti_00; do
  if [ -e "$data/${dataset#*:}" ]; then datasets+=(--dataset "${dataset%%:*}:$(printf %q "$data/${dataset#*:}")"); fi
done

folder=$(printf %q "$results")
steps=(tracking tracking_3 priors still motion lens effects distractors methods real map paper speed contract)
if [ -n "${TET_PL_VINS:-}" ]; then steps+=(vio); fi
declare -A pages=(
  [tracking]="docs/benchmarks/tracking.md, Every regime and Part by part"
  [tracking_3]="docs/benchmarks/tracking.md, Every regime"
  [priors]="docs/benchmarks/tracking.md, Motion priors"
  [still]="docs/benchmarks/tracking.md, Standing still"
  [motion]="docs/benchmarks/motion.md"
  [lens]="docs/benchmarks/lens.md"
  [effects]="docs/benchmarks/effects.md"
  [distractors]="docs/benchmarks/distractors.md"
  [methods]="docs/benchmarks/methods.md"
  [real]="docs/benchmarks/real.md"
  [map]="docs/vio.md, How good a map the tracks give"
  [paper]="docs/benchmarks/paper.md and docs/images (RESULTS/paper/results.md, *.png)"
  [speed]="docs/benchmarks/speed.md"
  [contract]="docs/vio.md, PL-VINS"
  [vio]="docs/benchmarks/vio.md")
declare -A commands=(
  [tracking]="scripts/measure_tracking.sh $folder/tracking '1001 1002' $(seconds 20)"
  [tracking_3]="scripts/measure_tracking.sh $folder/tracking_3 1003 $(seconds 20) 'fast corridor all'"
  [priors]="scripts/measure_priors.sh $folder/priors '1001 1002 1003 1004 1005 1006 1007 1008' $(seconds 6)"
  [still]="scripts/measure_tracking.sh $folder/still 1001 $(seconds 60) still"
  [motion]="scripts/measure_motion.sh $folder/motion '1001 1002' $(seconds 20)"
  [lens]="scripts/measure_lens.sh $folder/lens 1001 $(seconds 10)"
  [effects]="scripts/measure_effects.sh $folder/effects 1001 $(seconds 6)"
  [distractors]="scripts/measure_distractors.sh $folder/distractors 1001 $(seconds 6)"
  [methods]="scripts/measure_methods.sh $folder/methods 1001 $(seconds 10)"
  [real]="scripts/measure_real.sh $folder/real"
  [map]="scripts/measure_map.sh $folder/map 1001 $(seconds 40)"
  [paper]="python3 scripts/reproduce_paper $folder/paper --simulate $(seconds 6) ${datasets[*]}"
  [speed]="scripts/benchmark.sh"
  [contract]="scripts/check_contract.sh $(if $short; then echo 10; else echo 60; fi)"
  [vio]="scripts/vio_benchmark.sh $(printf %q "${TET_PL_VINS:-}") $folder/vio --seconds $(if $short; then echo 12; else echo 30; fi)")

chosen=("${arguments[@]}")
if [ ${#chosen[@]} -eq 0 ]; then chosen=("${steps[@]}"); fi
for step in "${chosen[@]}"; do
  [ -n "${commands[$step]:-}" ] || fail "there is no step $step: they are ${steps[*]}"
done
prepareTools
for step in "${chosen[@]}"; do
  output=$results/$step.txt
  if [ -e "$output" ]; then
    echo "$step: done before"
  else
    echo "$step: ${commands[$step]}"
    started=$SECONDS
    bash -c "${commands[$step]}" </dev/null >"$output.part" 2>"$results/$step.log" ||
      fail "$step failed: $(tail -n 1 "$results/$step.log") (all of it: $output.part, $results/$step.log)"
    echo "$(((SECONDS - started + 59) / 60)) min" >"$results/$step.minutes"
    mv "$output.part" "$output"
  fi
done
printf '\nWhere the results go; after that scripts/plot_benchmarks.sh draws the figures of docs/benchmarks.md:\n'
for step in "${steps[@]}"; do
  if [ -e "$results/$step.txt" ]; then
    printf '  %-34s %6s  %s\n' "$results/$step.txt" "$(cat "$results/$step.minutes")" "${pages[$step]}"
  else
    echo "  $step: not done"
  fi
done
