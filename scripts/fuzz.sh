#!/usr/bin/env bash
# Feeds random input to what takes data from outside: image messages, camera_info, calibration files, dataset tables, images through
# the tracker with any parameters and lens, lines and poses into the mapper and the bridge. Built with AddressSanitizer and
# UndefinedBehaviorSanitizer. Any crash, report, broken promise or error that was not promised fails, and leaves its input.
#
#   scripts/fuzz.sh [--libfuzzer] [SECONDS_EACH [RANDOM_SEED]]
#
# SECONDS_EACH: 60. --libfuzzer: guided by coverage; what it has learned stays in build/sanitized_fuzzer/corpus. Else mutations of
# the seeds in test/fuzz/seeds, or bytes of any length.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

guided=false
if [ "${1:-}" = --libfuzzer ]; then
  guided=true
  sanitizers=fuzzer
  shift
fi
answerHelp "$@"
readers=(calibration_file camera_info image_message line_stream line_tracker text_table)
buildSanitized "${readers[@]/#/fuzz_}"
cd "$sanitized"
export guided sanitized project
# So that the drivers can save the input.
UBSAN_OPTIONS+=:abort_on_error=1
# fuzz READER SECONDS [RANDOM_SEED]
fuzz() {
  local program=$sanitized/devel/lib/tet_line_tracker/fuzz_$1 seeds=$project/test/fuzz/seeds/$1 corpus=$sanitized/corpus/$1
  if [ ! -e "$seeds" ]; then seeds=$(mktemp -d); fi
  if ! $guided; then
    "$program" "$2" "$seeds" ${3:+"$3"} </dev/null
    return
  fi
  mkdir -p "$corpus"
  "$program" "$corpus" "$seeds" -max_total_time="$2" -max_len=16384 -timeout=60 -rss_limit_mb=4096 -verbosity=0 -print_final_stats=1 \
    ${3:+-seed="$3"} </dev/null >"$1.log" 2>&1 ||
    { tail -n 40 "$1.log" >&2; echo "fuzz_$1 found something (the input is in $sanitized)" >&2; return 1; }
  echo "fuzz_$1: $(sed -n 's/^stat::number_of_executed_units: *//p' "$1.log") inputs, $(find "$corpus" -type f | wc -l) that reach something new, nothing found"
}
export -f fuzz
printf '%s\n' "${readers[@]}" | xargs -P "$(nproc)" -I{} bash -c 'fuzz "$@"' fuzz {} "${1:-60}" ${2:+"$2"} || fail "a fuzzer found something"
