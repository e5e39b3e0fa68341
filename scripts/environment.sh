# What every script here starts with; sourced. Leaves the caller in the root of the project.

cd "$(dirname "${BASH_SOURCE[0]}")/.."
project=$PWD
build=$project/build

# ROS tools need the distribution's python3, also where pyenv or conda put another one first.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin:$PATH
# Without these a host name that does not resolve stops every node, and logs appear only at the end.
export ROS_HOSTNAME=${ROS_HOSTNAME:-localhost} ROSCONSOLE_STDOUT_LINE_BUFFERED=1

. scripts/packages.sh

fail() {
  echo "$(basename "$0"): $1" >&2
  exit 1
}

# Prints the comment at the head of the script.
printHelp() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "scripts/$(basename "$0")"; }

# For scripts that take no options: --help prints the help and ends the script.
answerHelp() {
  local argument
  for argument in "$@"; do
    case $argument in
      --help | -h) printHelp && exit ;;
      -*) fail "unknown option $argument; see --help" ;;
    esac
  done
}

# The setup files of ROS read unset variables.
sourceSetup() {
  set +u
  . "$1"
  set -u
}

if [ -e /opt/ros/noetic/setup.bash ]; then
  sourceSetup /opt/ros/noetic/setup.bash
  export PATH=/usr/sbin:/usr/bin:/sbin:/bin:$PATH
fi

areInstalled() {
  [ "$(dpkg-query -W -f='${db:Status-Status}\n' "$@" 2>/dev/null | grep -cx installed)" = $# ]
}

# Installs those of the named Debian packages that are missing. Name all that a script needs at once, so that the line
# which is printed where there is no sudo is the whole of it.
requirePackages() {
  local installed package missing=() as_root=() log=$build/install.log
  command -v dpkg-query >/dev/null || fail "this is no Debian or Ubuntu: install the packages of scripts/packages.sh by hand"
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p') || true
  for package in "$@"; do
    grep -qxF "$package" <<<"$installed" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || fail "as root, install what is missing, then start again:
apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
    as_root=(sudo)
    if [ "${CI:-}" = true ]; then as_root+=(-n); fi
  fi
  as_root+=(env DEBIAN_FRONTEND=noninteractive)
  echo "Installing ${#missing[@]} packages and what they need (up to 0.5 GB to download): ${missing[*]}"
  mkdir -p "$build"
  : >"$log"
  if ! compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null; then
    "${as_root[@]}" apt-get update </dev/null >"$log" 2>&1 || fail "apt-get update failed: $(tail -n 1 "$log")"
  fi
  if ! withNews "${as_root[@]}" apt-get install -y --no-install-recommends "${missing[@]}"; then
    # Package lists may be older than the archive.
    "${as_root[@]}" apt-get update </dev/null >>"$log" 2>&1 || true
    withNews "${as_root[@]}" apt-get install -y --no-install-recommends "${missing[@]}" ||
      fail "apt-get could not install ${missing[*]}: $(grep '^E:' "$log" | tail -n 1) (all of it: build/install.log)"
  fi
}

# Runs apt-get, whose long text goes to $log; says how much there is to fetch, and every while that it still works.
withNews() {
  local apt status=0 seconds=0 told=false
  "$@" </dev/null >>"$log" 2>&1 &
  apt=$!
  while kill -0 $apt 2>/dev/null; do
    sleep 1
    seconds=$((seconds + 1))
    if ! $told && grep '^Need to get ' "$log"; then told=true; fi
    if [ $((seconds % 30)) = 0 ]; then echo "... $seconds s: $(tail -n 1 "$log" | cut -c 1-100)"; fi
  done
  wait $apt || status=$?
  return $status
}

requireLocalhost() {
  getent hosts localhost >/dev/null ||
    fail "the name localhost does not resolve, and ROS needs it: add the line '127.0.0.1 localhost' to /etc/hosts"
}

# Builds the named targets with the sanitizers that `sanitizers` names, in a folder of their own; those of "fuzzer" by clang, with
# libFuzzer as the driver of the fuzzers.
sanitizers=address,undefined
sanitized=$build/sanitized
buildSanitized() {
  local options=() flags=-fsanitize=$sanitizers
  requirePackages "${packages_build[@]}" "${packages_test[@]}"
  case $sanitizers in
    thread) sanitized=$build/sanitized_thread ;;
    fuzzer)
      requirePackages "${packages_libfuzzer[@]}"
      sanitized=$build/sanitized_fuzzer
      options=(-DCMAKE_CXX_COMPILER=clang++ -DTET_LIBFUZZER=ON)
      flags="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined" ;;
    # With counters for coverage.sh --core, which miscount in threads: atomic ones take up to 17 times as long.
    *) flags+=" -fno-sanitize-recover=undefined --coverage" ;;
  esac
  mkdir -p "$sanitized/devel/lib/python3/dist-packages"
  if [ ! -e "$sanitized/build.ninja" ]; then
    if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
    cmake -S . -B "$sanitized" -G Ninja -DCMAKE_BUILD_TYPE=None -DCATKIN_ENABLE_TESTING=ON -DTET_FUZZ=ON "${options[@]}" \
      -DCMAKE_CXX_FLAGS="-O1 -g1 $flags -fno-omit-frame-pointer" \
      >"$sanitized/configure.log" 2>&1 || { cat "$sanitized/configure.log" >&2; fail "CMake could not configure the sanitized build"; }
  fi
  cmake --build "$sanitized" --target "$@"
  export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1
}

# Renders the flight of demo.sh and soak.sh, once. Needs the build.
flight=$build/demo/flight.bag
requireFlight() {
  [ -e "$flight" ] && return
  mkdir -p "$build/demo"
  echo "Simulating a flight, once ..."
  "$build/devel/lib/tet_line_tracker/simulate_bag" "$flight" --seconds 10
}

# writeLens FILE WIDTH HEIGHT F CX CY MODEL COEFFICIENTS: a calibration file.
writeLens() {
  cat >"$1" <<END
image_width: $2
image_height: $3
camera_name: $(basename "$1" .yaml)
camera_matrix: {rows: 3, cols: 3, data: [$4, 0, $5, 0, $4, $6, 0, 0, 1]}
distortion_model: $7
distortion_coefficients: {rows: 1, cols: $(wc -w <<<"${8//,/ }"), data: [$8]}
END
}

# greyRectangle PIXELS: an image (PGM) with a rectangle that is shifted by so many pixels.
greyRectangle() {
  awk -v shift="$1" 'BEGIN {
    print "P2 320 240 255"
    for (y = 0; y < 240; ++y)
      for (x = 0; x < 320; ++x) print (x >= 80 + shift && x < 240 + shift && y >= 60 && y < 180) ? 180 : 40
  }'
}

# Starts a master on a free port, so that parameters and topics of somebody else's stay as they are. Whatever is in
# `children` ends with the script.
children=()
stopChildren() {
  # Again after a while: one that is just starting does not listen yet. One that never does is not waited for.
  local tries
  for tries in 1 2 3 4 5 6 7 8; do
    kill -INT "${children[@]}" 2>/dev/null || break
    sleep 2
  done
  kill -KILL "${children[@]}" 2>/dev/null || true
  wait
}
chooseMaster() {
  local port
  port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])')
  export ROS_MASTER_URI=http://localhost:$port
}
startMaster() {
  chooseMaster
  trap stopChildren EXIT
  # roslaunch ends without an error after Ctrl-C; the script must not go on then.
  trap 'exit 130' INT
  roscore -p "${ROS_MASTER_URI##*:}" >"$build/roscore.log" 2>&1 &
  children+=($!)
}
