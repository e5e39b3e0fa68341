#!/usr/bin/env bash
# Feeds random mutations of image messages, camera_info, calibration files and dataset tables to their readers, built
# with sanitizers in build/sanitized. Any crash, report or error that was not promised fails.
#
#   scripts/fuzz.sh [SECONDS_EACH [RANDOM_SEED]]
set -euo pipefail
. "$(dirname "$0")/environment.sh"

answerHelp "$@"
readers=(calibration_file camera_info image_message text_table)
buildSanitized "${readers[@]/#/fuzz_}"
cd "$sanitized"
for reader in "${readers[@]}"; do
  seeds=$project/test/fuzz/seeds/$reader
  if [ ! -e "$seeds" ]; then seeds=$(mktemp -d); fi
  "$sanitized/devel/lib/tet_line_tracker/fuzz_$reader" "${1:-60}" "$seeds" ${2:+"$2"} </dev/null
done
