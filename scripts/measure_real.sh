#!/usr/bin/env bash
# Tracks recorded sequences and judges the lines by depth, by three views and poses, and by homographies: docs/benchmarks/real.md.
#
#   scripts/measure_real.sh RESULTS [--check | --update] [--set NAME=VALUE ...] [FORMAT:FOLDER ...]
#
# RESULTS: folder for bags, pictures and tables; sequences that are there are used again. FORMAT:FOLDER: a sequence of yours as
# dataset_to_bag takes it (euroc:/data/V1_02_medium/mav0); without any the extracts in ../shared/data (or TET_SHARED_DATA), those that
# are there. Beside the default the baselines lsd_lbd_knn and lk_endpoints, and a picture of the tracks of each sequence.
# --check: only the default, on the extracts, compared with test/regression/real.csv; exit status 1 when a measure is worse by more
# than its tolerance (scripts/check_regression.py). --update: write that file anew. --set: a parameter of the tracker.
set -euo pipefail
mode=measure
options=()
set_next=false
for argument in "$@"; do
  shift
  if $set_next; then
    options+=(--set "$argument")
    set_next=false
    continue
  fi
  case $argument in
    --check | --update) mode=${argument#--} ;;
    --set) set_next=true ;;
    *) set -- "$@" "$argument" ;;
  esac
done
. "$(dirname "$0")/measuring.sh"
if $tuning; then fail "recorded sequences have no seeds: --tuning means nothing here"; fi
if $set_next; then fail "--set needs NAME=VALUE; see --help"; fi
baseline=test/regression/real.csv
data=${TET_SHARED_DATA:-../shared/data}

names=()
sources=()
if [ ${#arguments[@]} -gt 0 ]; then
  [ $mode = measure ] || fail "--$mode is for the extracts, which test/regression/real.csv is of: name no sequence"
  for argument in "${arguments[@]}"; do
    folder=$(cd "$caller" && realpath -m "${argument#*:}")
    [[ $argument == *:* ]] || fail "'$argument' is not FORMAT:FOLDER; see --help"
    [ -e "$folder" ] || fail "there is no $folder"
    names+=("$(basename "${folder%/mav0}")")
    sources+=("${argument%%:*} $folder")
  done
else
  for extract in euroc:euroc_v1_01/mav0 icl_nuim:icl_nuim_of_kt0 kitti:kitti_00 tum:tum_fr3_structure_notexture_far; do
    folder=$data/${extract#*:}
    if [ ! -e "$folder" ]; then
      echo "skipped: ${extract#*:} is not in $data"
      continue
    fi
    names+=("$(cut -d/ -f1 <<<"${extract#*:}")")
    sources+=("${extract%%:*} $folder")
  done
fi
if [ ${#names[@]} -eq 0 ]; then
  echo "skipped: there are no recorded sequences; name some, see --help"
  exit 0
fi
prepareTools

# judge NAME [track_bag options]: one table and NAME.csv.
judge() {
  local name=$1 tracked=()
  shift
  for sequence in "${names[@]}"; do
    "$tools/track_bag" "$results/$sequence.bag" "$results/$sequence-$name.bag" --times "$@" >"$results/$sequence-$name.txt"
    tracked+=("$results/$sequence-$name.bag")
  done
  heading "$name" "${options[@]}"
  "$tools/evaluate_tracks" --csv "$results/$name.csv" "${tracked[@]}"
}

for i in "${!names[@]}"; do
  sequence=$results/${names[$i]}.bag
  read -r format folder <<<"${sources[$i]}"
  [ -e "$sequence" ] || "$tools/dataset_to_bag" "$format" "$folder" "$sequence" </dev/null
done
judge tet "${options[@]}"
case $mode in
  check) scripts/check_regression.py "$baseline" "$results/tet.csv" ;;
  update) scripts/check_regression.py --write "$baseline" "$results/tet.csv" ;;
  measure)
    judge lsd_lbd_knn --tracker lsd_lbd_knn
    judge lk_endpoints --tracker lk_endpoints
    for sequence in "${names[@]}"; do
      "$tools/paint_tracks" "$results/$sequence-tet.bag" "$results/$sequence.png" --images "$results/$sequence.bag" --number 20 >/dev/null
    done
    scripts/real_table.py "tet=$results/tet.csv" "lsd_lbd_knn=$results/lsd_lbd_knn.csv" "lk_endpoints=$results/lk_endpoints.csv" |
      tee "$results/tables.md"
    ;;
esac
