# Roots of Debian in a temporary folder, to try things in as on a new machine; sourced after environment.sh. Needs root.

# Sets `mirror` and `suite` to where this machine takes its own packages from.
findMirror() {
  read -r mirror suite < <(
    apt-get indextargets --format '$(COMPONENT) $(REPO_URI) $(CODENAME)' 'Identifier: Packages' 'Origin: Debian' |
      awk '$1 == "main" && $3 !~ /-/ { print $2, $3; exit }') ||
    fail "apt-get indextargets names no archive of Debian: start on Debian, after apt-get update"
}

# makeFreshRoot [SUITE]: sets `fresh_root` to the folder of a new root of Debian, SUITE (bookworm) or what this machine runs, which
# goes when the script ends.
makeFreshRoot() {
  local mirror suite log=$build/debootstrap.log
  [ "$(id -u)" = 0 ] || fail "a new root of Debian needs the rights of root: start it with sudo"
  requirePackages "${packages_fresh_root[@]}"
  findMirror
  suite=${1:-$suite}
  fresh_root=$(mktemp -d)
  trap removeFreshRoot EXIT
  mkdir -p "$build"
  echo "Installing Debian $suite from $mirror ..."
  debootstrap --variant=minbase "$suite" "$fresh_root" "$mirror" >"$log" 2>&1 ||
    { tail -n 5 "$log" >&2; fail "debootstrap failed (build/debootstrap.log)"; }
  mountpoint -q "$fresh_root/proc" || mount -t proc proc "$fresh_root/proc" || true
  mkdir -p "$fresh_root/dev/pts"
  mountpoint -q "$fresh_root/dev/pts" || mount -t devpts devpts "$fresh_root/dev/pts" || true
  echo force-unsafe-io >"$fresh_root/etc/dpkg/dpkg.cfg.d/force-unsafe-io"
  echo "127.0.0.1 localhost" >"$fresh_root/etc/hosts"
}

removeFreshRoot() {
  umount "$fresh_root/dev/shm" "$fresh_root/dev/pts" "$fresh_root/proc" 2>/dev/null || true
  rm -rf --one-file-system "$fresh_root"
}

# inFreshRoot COMMAND ...: with the environment of a new shell, nothing of this machine's ROS.
inFreshRoot() {
  env -i HOME=/root USER=root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 chroot "$fresh_root" "$@" </dev/null
}
