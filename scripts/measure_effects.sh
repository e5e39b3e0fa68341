#!/usr/bin/env bash
# What a camera's effects on its pictures cost: each alone and all together, beside a camera without any. The table of
# docs/benchmarks/effects.md.
#
#   scripts/measure_effects.sh RESULTS [--tuning] [SEEDS [SECONDS]]
#
# RESULTS: folder for bags and tables; flights that are there are used again. SEEDS: of the flights ("1001 1002"), from 1000 on;
# below 1000 with --tuning. SECONDS: of a flight (8).
set -euo pipefail
. "$(dirname "$0")/measuring.sh"
read -r -a seeds <<<"${arguments[0]:-$(defaultSeed) $(($(defaultSeed) + 1))}"
seconds=${arguments[1]:-8}
requireSeeds "${seeds[@]}"
prepareTools

trackWith --absolute --camera-effects none response sharpening jpeg vignette hot_pixels defocus skewed_blur rolling_shutter all |
  tee "$results/evaluation.txt"
scripts/effects_table.py "tet=$results/tet.csv" "lsd_lbd_knn=$results/lsd_lbd_knn.csv" | tee "$results/tables.md"
