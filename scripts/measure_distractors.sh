#!/usr/bin/env bash
# What things without straight edges of their own do to lines: each distractor of simulate_bag alone and all together, beside a room
# without any. The tables of docs/benchmarks/distractors.md.
#
#   scripts/measure_distractors.sh RESULTS [--tuning] [SEEDS [SECONDS]]
#
# RESULTS: folder for bags and tables; flights that are there are used again. SEEDS: of the flights ("1001 1002"), from 1000 on;
# below 1000 with --tuning. SECONDS: of a flight (8).
set -euo pipefail
. "$(dirname "$0")/measuring.sh"
read -r -a seeds <<<"${arguments[0]:-$(defaultSeed) $(($(defaultSeed) + 1))}"
seconds=${arguments[1]:-8}
requireSeeds "${seeds[@]}"
prepareTools

trackWith --surfaces --distractors none round cables foliage people mirror glossy_floor screen all | tee "$results/evaluation.txt"
scripts/distractors_table.py "tet=$results/tet.csv" "lsd_lbd_knn=$results/lsd_lbd_knn.csv" | tee "$results/tables.md"
