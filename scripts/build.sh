#!/usr/bin/env bash
# Installs what is missing (apt) and builds Release in build/. Afterwards build/devel/setup.bash can be sourced.
#
#   scripts/build.sh [--tests] [-DNAME=VALUE ...]
#
# --tests builds the tests too; -D options go to CMake. CI=true makes warnings errors.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

tests=false
options=()
for argument in "$@"; do
  case $argument in
    --tests) tests=true ;;
    -D*) options+=("$argument") ;;
    --help | -h) sed -n '2,6s/^# \{0,1\}//p' scripts/build.sh && exit ;;
    *) fail "unknown option $argument; see --help" ;;
  esac
done

packages=("${packages_build[@]}" "${packages_run[@]}")
if $tests; then packages+=("${packages_test[@]}"); fi
requirePackages "${packages[@]}"

if [ ! -e "$build/CMakeCache.txt" ]; then
  options=(-G Ninja -DCMAKE_BUILD_TYPE=Release -DCATKIN_ENABLE_TESTING=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "${options[@]}")
  if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  # rosrun looks for no program below a package's build/: the devel space lies beside it, build/devel leads there.
  mkdir -p "$build" "$project/devel"
  if [ ! -e "$build/devel" ]; then ln -s ../devel "$build/devel"; fi
  options+=("-DCATKIN_DEVEL_PREFIX=$project/devel")
  # catkin keeps the environment of the first configure and leaves out folders that are not there yet.
  mkdir -p "$build/devel/lib/python3/dist-packages"
fi
configured() { grep -qs "^$1:[A-Z]*=ON" "$build/CMakeCache.txt"; }
if $tests && ! configured CATKIN_ENABLE_TESTING; then options+=(-DCATKIN_ENABLE_TESTING=ON); fi
if [ "${CI:-}" = true ] && ! configured TET_WARNINGS_AS_ERRORS; then options+=(-DTET_WARNINGS_AS_ERRORS=ON); fi

# CMake leaves the displays of rviz out where these are missing, and does not look again by itself.
displays=false
if grep -qsE '^(Qt[56]|rviz)_DIR:PATH=.*-NOTFOUND$' "$build/CMakeCache.txt" && areInstalled "${packages_displays[@]}"; then
  displays=true
fi

# A first configure that failed leaves a cache but nothing to build from.
if [ ${#options[@]} -gt 0 ] || $displays || ! compgen -G "$build/build.ninja" >/dev/null && ! compgen -G "$build/Makefile" >/dev/null; then
  cmake -S . -B "$build" "${options[@]}" >"$build/configure.log" 2>&1 ||
    { cat "$build/configure.log" >&2; fail "CMake could not configure the project"; }
fi
targets=(all)
if $tests; then targets+=(tests); fi
if [ -t 1 ]; then
  cmake --build "$build" --target "${targets[@]}" -- -j "$(nproc)"
else
  # catkin's checks of messages run at every build: no news.
  cmake --build "$build" --target "${targets[@]}" -- -j "$(nproc)" | { grep --line-buffered -v genmsg_check_deps || true; }
fi
