#!/usr/bin/env bash
# Installs the package in a temporary folder and uses it from there: no file names the source folder, the demo plays, and two packages
# build on top of it, one that links the core and one that has only the messages.
#
#   scripts/test_install.sh [--move-source]
#
# --move-source: moves the source folder away while the installed package is used, and back afterwards.
set -euo pipefail
. "$(dirname "$0")/environment.sh"

move_source=false
for argument in "$@"; do
  case $argument in
    --move-source) move_source=true ;;
    --help | -h) printHelp && exit ;;
    *) fail "unknown option $argument; see --help" ;;
  esac
done

requireLocalhost
requirePackages "${packages_build[@]}" "${packages_run[@]}"
scripts/build.sh
requireFlight

work=$(mktemp -d)
prefix=$work/install
install_log=$build/install_space.log
# setPrefix FOLDER: catkin writes the place into the files that it installs, so it is set before they are made.
setPrefix() { cmake -S "$project" -B "$build" -DCMAKE_INSTALL_PREFIX="$1" >>"$install_log" 2>&1; }
previous=$(sed -n 's/^CMAKE_INSTALL_PREFIX:PATH=//p' "$build/CMakeCache.txt")
moved=$project.moved
is_moved=false
cleanUp() {
  if $is_moved; then mv "$moved" "$project"; fi
  setPrefix "$previous"
  rm -rf "$work"
}
trap cleanUp EXIT
: >"$install_log"
{ setPrefix "$prefix" && cmake --build "$build" --target install >>"$install_log" 2>&1; } ||
  { tail -n 5 "$install_log" >&2; fail "the package could not be installed (build/install_space.log)"; }
# Programs and libraries hold the names of their source files for messages of errors.
if naming=$(grep -rlIF "$project" "$prefix"); then
  fail "these installed files name the source folder:
$naming"
fi

cp -r examples "$work/examples"
cp "$flight" "$work/flight.bag"
cd "$work"
if $move_source; then
  [ ! -e "$moved" ] || fail "$moved is there already: move it away"
  mv "$project" "$moved"
  is_moved=true
fi

# useInstalled COMMAND ...: in a shell that knows the installed package and no other build of it.
useInstalled() {
  env -i HOME="$work" PATH=/usr/sbin:/usr/bin:/sbin:/bin ROS_HOSTNAME="$ROS_HOSTNAME" bash -c '. "$0/setup.bash" && exec "$@"' "$prefix" "$@" </dev/null
}

for package in downstream_core downstream_messages; do
  { useInstalled cmake -S "examples/$package" -B "build_$package" -DCATKIN_DEVEL_PREFIX="$work/devel_$package" &&
    useInstalled cmake --build "build_$package"; } >"$package.log" 2>&1 || { cat "$package.log" >&2; fail "$package does not build"; }
done
greyRectangle 0 >first.pgm
greyRectangle 3 >second.pgm
useInstalled devel_downstream_core/lib/downstream_core/track_two_images first.pgm second.pgm >lines
grep -q '^line [0-9]*: (' lines || fail "the program that links the installed core tracked no line"

chooseMaster
useInstalled roslaunch -p "${ROS_MASTER_URI##*:}" tet_line_tracker demo.launch bag:="$work/flight.bag" rviz:=false >launch.log 2>&1 ||
  { tail -n 30 launch.log >&2; fail "the demo did not play from the install space"; }
useInstalled rosrun tet_line_tracker track_bag flight.bag tracks.bag >track_bag.log 2>&1 || { cat track_bag.log >&2; fail "track_bag failed"; }
useInstalled rosrun tet_line_tracker check_lines tracks.bag
grep -qE 'process has died|ERROR' launch.log && { cat launch.log >&2; fail "the demo said an error"; }
echo "The installed package works without its source: $(find "$prefix" -type f | wc -l) files, two packages on top of it."
