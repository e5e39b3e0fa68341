#!/usr/bin/env bash
# Maps simulated flights with true poses and judges the maps by the true edges: the table "How good a map the tracks give" of
# docs/vio.md.
#
#   scripts/measure_map.sh RESULTS [--tuning] [SEED [SECONDS]]
#
# RESULTS: folder for bags and tables; flights that are there are used again. SEED: of the flights (1001), from 1000 on; below 1000
# with --tuning. SECONDS: of a flight (40).
set -euo pipefail
. "$(dirname "$0")/measuring.sh"
takeSeedAndSeconds 40
prepareTools

# Square images, whose largest circle is the field of view.
writeLens "$results/equidistant.yaml" 752 752 226.7 375.5 375.5 equidistant "0, 0, 0, 0"               # 190 degrees
writeLens "$results/mei.yaml" 700 700 668.2 349.5 349.5 mei "2.2134, 0.0168, 1.6549, 0, 0"  # 185 degrees, as KITTI-360

declare -A flights=(
  [slow]="--motion slow" [shake]="--motion shake" [equidistant]="--motion slow --camera-info $results/equidistant.yaml"
  [mei]="--motion slow --camera-info $results/mei.yaml")

maps=()
# map FLIGHT TRACKER: tracks, holds the lines against their rules, and maps.
map() {
  local flight=$results/$1-$seed.bag name=$1-$seed-$2
  # The flight's words are options.
  # shellcheck disable=SC2086
  simulate "$flight" "$seed" ${flights[$1]} --seconds "$seconds"
  "$tools/track_bag" "$flight" "$results/$name-tracks.bag" --tracker "$2" >"$results/$name.txt"
  "$tools/check_lines" "$results/$name-tracks.bag"
  "$tools/map_bag" "$results/$name-tracks.bag" "$results/$name.bag"
  maps+=("$results/$name.bag")
}
{
  heading maps
  map slow tet
  map slow lk_endpoints
  map slow lsd_lbd_knn
  map shake tet
  map equidistant tet
  map mei tet
  "$tools/evaluate_map" "${maps[@]}"
} | tee "$results/maps.txt"
