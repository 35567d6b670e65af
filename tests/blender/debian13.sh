#!/bin/sh
# Makes the root of a Debian 13 with Blender 4.3 once, and prints its folder. Minutes and 2 GB, so it is kept in a cache folder.
# usage: debian13.sh     FOCAL_BLENDER_ROOT: where (~/.cache/focal/debian13-blender)      77: it cannot be made here
set -eu
root=${FOCAL_BLENDER_ROOT:-${XDG_CACHE_HOME:-$HOME/.cache}/focal/debian13-blender}
mirror=${FOCAL_DEBIAN_MIRROR:-http://deb.debian.org/debian}

skip() {
  echo "skipped: $1" >&2
  exit 77
}

if [ -f "$root/complete" ]; then
  echo "$root"
  exit 0
fi
[ "$(id -u)" -eq 0 ] || skip "only root can make the Debian 13 root that Blender 4.3 runs in"
command -v debootstrap > /dev/null || skip "debootstrap is not installed (.ci/bootstrap.sh ci)"
mkdir -p "$(dirname "$root")"
exec 9> "$root.lock"
flock 9 # two tests may want it at once
if [ ! -f "$root/complete" ]; then
  rm -rf "$root" # what an attempt left behind: nothing is mounted in it
  {
    debootstrap --variant=minbase trixie "$root" "$mirror" &&
      chroot "$root" env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends \
        blender libgl1-mesa-dri python3-numpy xvfb &&
      rm -rf "$root"/var/cache/apt/archives/*.deb "$root"/var/lib/apt/lists/*
  } > "$root.log" 2>&1 || skip "Debian 13 with Blender could not be made, see $root.log: $(tail -n 1 "$root.log")"
  touch "$root/complete"
fi
echo "$root"
