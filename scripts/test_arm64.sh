#!/usr/bin/env bash
# Builds the core alone (no ROS) for 64-bit ARM and runs its tests on this amd64 machine, in an emulator. Then tracks the same
# generated images with the builds for both processors: every image must give the same lines, bit by bit.
#
#   scripts/test_arm64.sh
#
# Needs Debian, and 1.5 GB in build/arm64, where the libraries for ARM and the build stay for the next run. Not covered: the
# nodes, and how long anything takes on a real processor.
set -euo pipefail
. "$(dirname "$0")/environment.sh"
. scripts/fresh_root.sh

arm64=$build/arm64
root=$arm64/root
emulator=(/usr/bin/qemu-aarch64-static -L "$root")

# apt for the packages of arm64, in a folder of its own: nothing of this machine changes, and no right of root is needed.
armApt() {
  apt-get -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User= -o Dir::State="$arm64/apt" \
    -o Dir::State::status="$arm64/apt/status" -o Dir::Cache="$arm64/apt" -o Dir::Etc::SourceList="$arm64/apt/sources.list" \
    -o Dir::Etc::SourceParts=/dev/null -o Dir::Etc::PreferencesParts=/dev/null "$@" </dev/null >>"$arm64/apt.log" 2>&1 ||
    fail "apt-get for arm64 failed: $(grep '^E:' "$arm64/apt.log" | tail -n 1) (all of it: build/arm64/apt.log)"
}

# Libraries and headers for ARM in $root: unpacked, not installed, so no program of theirs has to run.
requireRoot() {
  local wanted="${packages_arm64_root[*]}" package link target mirror suite lib=$root/usr/lib/aarch64-linux-gnu
  [ "$(cat "$root.packages" 2>/dev/null)" != "$wanted" ] || return 0
  rm -rf "$root" "$root.packages" "$arm64/apt" "$arm64/core" "$arm64/apt.log"
  mkdir -p "$arm64/apt/lists/partial" "$arm64/apt/archives/partial" "$root/usr/lib"
  findMirror
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $suite main" >"$arm64/apt/sources.list"
  : >"$arm64/apt/status"
  echo "Fetching the libraries of Debian $suite for arm64 from $mirror, once (about 250 MB) ..."
  armApt update
  armApt install -y --download-only --no-install-recommends "${packages_arm64_root[@]}"

  ln -s usr/lib "$root/lib"
  for package in "$arm64"/apt/archives/*.deb; do
    # Through the link from lib to usr/lib.
    dpkg-deb --fsys-tarfile "$package" | tar -x -C "$root" --keep-directory-symlink --exclude=./usr/share/doc
  done
  rm -rf "$arm64/apt"
  # Links that the scripts of the packages would have made.
  ln -s blas/libblas.so.3 lapack/liblapack.so.3 "$lib"
  # Links from the root of the file system would lead to the libraries of this machine.
  find "$root" -type l -lname '/*' | while read -r link; do
    target=$root$(readlink "$link")
    if [ -e "$target" ]; then ln -sfr "$target" "$link"; fi
  done
  echo "$wanted" >"$root.packages"
}

configureCore() {
  local launcher=()
  if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  cmake -S src/core -G Ninja "${launcher[@]}" "$@" >"$arm64/configure.log" 2>&1 ||
    { cat "$arm64/configure.log" >&2; fail "CMake could not configure the core"; }
}

buildCore() {
  [ -e "$build/core/build.ninja" ] || configureCore -B "$build/core"
  [ -e "$arm64/core/build.ninja" ] || configureCore -B "$arm64/core" \
    -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ \
    -DCMAKE_SYSROOT="$root" -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY \
    -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY \
    -DCMAKE_CROSSCOMPILING_EMULATOR="$(IFS=';' && echo "${emulator[*]}")"
  cmake --build "$build/core" --target hash_tracks
  cmake --build "$arm64/core"
}

# Names the first image of each sequence for which the builds do not agree.
compareTracks() {
  "$build/core/hash_tracks" >"$arm64/hashes.amd64"
  "${emulator[@]}" "$arm64/core/hash_tracks" >"$arm64/hashes.arm64"
  awk '
    { sequence = $0; sub(/ image .*/, "", sequence); place = $0; sub(/^.* image /, "", place); split(place, word, " ") }
    FILENAME == ARGV[1] { images[sequence, word[1]] = word[2]; lines[sequence, word[1]] = word[4]; next }
    {
      if (!(sequence in count)) order[++sequences] = sequence
      ++count[sequence]
      total[sequence] += word[5]
      if (sequence in verdict) next
      if (images[sequence, word[1]] != word[2]) verdict[sequence] = "DIFFERENT image " word[1]
      else if (lines[sequence, word[1]] != word[4]) verdict[sequence] = "DIFFERENT lines from image " word[1] " on"
    }
    END {
      for (i = 1; i <= sequences; ++i) {
        name = order[i]
        printf "%-20s %3d images %5d lines  %s\n", name, count[name], total[name], name in verdict ? verdict[name] : "same"
        different += name in verdict
      }
      exit sequences == 0 || different > 0
    }' "$arm64/hashes.amd64" "$arm64/hashes.arm64" ||
    fail "the lines differ between amd64 and arm64 (build/arm64/hashes.*)"
}

testCore() {
  # The package test starts the compiler of this machine; test_core.sh runs it.
  (cd "$arm64/core" && ctest --output-on-failure -j "$(nproc)" --timeout 900 -E '^CorePackage\.' </dev/null)
}

answerHelp "$@"
[ $# = 0 ] || fail "takes no arguments; see --help"
[ "$(dpkg --print-architecture 2>/dev/null)" = amd64 ] || fail "this compares with amd64, so it runs there, on Debian"
requirePackages "${packages_core[@]}" "${packages_arm64[@]}"
mkdir -p "$arm64"
requireRoot
buildCore
compareTracks
testCore
