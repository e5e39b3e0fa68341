#!/usr/bin/env bash
# Builds, tests and installs the core alone in build/core, without catkin and ROS. Then builds examples/core_only outside the
# source folder against the installed package, and tracks two images with it.
#
#   scripts/test_core.sh [--fresh-root [SUITE]]
#
# --fresh-root: in a new Debian root that has no package of ROS (needs root, about 2 GB for a while). SUITE: of Debian,
# e.g. trixie; else this machine's.
set -euo pipefail
. "$(dirname "$0")/environment.sh"
. scripts/fresh_root.sh

testCore() {
  local outside prefix=$build/core/prefix
  requirePackages "${packages_core[@]}"
  mkdir -p "$build"
  outside=$(mktemp -d)
  trap "rm -rf '$outside'" EXIT

  if [ ! -e "$build/core/CMakeCache.txt" ]; then
    local options=()
    if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
    cmake -S src/core -B "$build/core" -G Ninja "${options[@]}" || fail "CMake could not configure the core alone"
  fi
  cmake --build "$build/core"
  (cd "$build/core" && ctest --output-on-failure -j "$(nproc)" --timeout 300 </dev/null)
  rm -rf "$prefix"
  cmake --install "$build/core" --prefix "$prefix" >"$build/core/install.log"

  cp -r examples "$outside"
  cmake -S "$outside/examples/core_only" -B "$outside/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix"
  cmake --build "$outside/build"
  greyRectangle 0 >"$outside/first.pgm"
  greyRectangle 3 >"$outside/second.pgm"
  "$outside/build/track_two_images" "$outside/first.pgm" "$outside/second.pgm" | tee "$outside/lines"
  grep -q '^line [0-9]*: (' "$outside/lines" || fail "the program outside the source folder tracked no line"
}

testInFreshRoot() {
  local installed
  makeFreshRoot "$@"
  mkdir "$fresh_root/project"
  cp -r cmake config examples include package.xml scripts src test "$fresh_root/project"
  inFreshRoot project/scripts/test_core.sh
  installed=$(inFreshRoot dpkg -l | awk '$1 ~ /^.i/ { print $2 }')
  if grep -E '^(lib)?(ros|catkin|nodelet|pluginlib|cv-bridge|python3-(ros|catkin))' <<<"$installed"; then
    fail "these packages of ROS were installed in the root"
  fi
  echo "No package of ROS among the $(wc -l <<<"$installed") packages of the root."
}

case ${1:-} in
  "") testCore ;;
  --fresh-root) testInFreshRoot "${@:2}" ;;
  --help | -h) sed -n '2,8s/^# \{0,1\}//p' scripts/test_core.sh ;;
  *) fail "unknown option $1; see --help" ;;
esac
