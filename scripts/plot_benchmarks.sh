#!/usr/bin/env bash
# Draws the figures at the top of docs/benchmarks.md from the tables in docs/benchmarks/.
#
#   scripts/plot_benchmarks.sh [FOLDER]
#
# FOLDER: where the figures go (docs/images/benchmarks).
set -euo pipefail
case ${1:-} in
  --help | -h) sed -n '2,6s/^# \{0,1\}//p' "$0" && exit ;;
esac
folder=$(realpath -m "${1:-$(dirname "$0")/../docs/images/benchmarks}")
. "$(dirname "$0")/environment.sh"

requirePackages "${packages_plot[@]}"
python3 scripts/plot_benchmarks.py docs/benchmarks "$folder"
