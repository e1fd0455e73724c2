#!/usr/bin/env bash
# clean_system.sh PACKAGES FOLDER: installs the packages (*.deb) of a folder into a new Debian 12 in
# FOLDER, which debootstrap makes, and uses them there. Needs root, a network and 4 GB; minutes.
set -euo pipefail
[ $# -eq 2 ] || { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }
packages="$(realpath "$1")"
root="$(realpath -m "$2")"
here="$(cd "$(dirname "$0")" && pwd)"

inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin HOME=/root LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "$@"
}

command -v debootstrap >/dev/null || apt-get install -y -q --no-install-recommends debootstrap
[ -e "$root/etc/debian_version" ] || debootstrap --variant=minbase bookworm "$root"
rm -rf "$root/packages" "$root/trial"
mkdir -p "$root/packages" "$root/trial"
cp "$packages"/*.deb "$root/packages"
cp "$here/in_clean_system.sh" "$here/pkg_config/version.c" "$root/trial"
cp -r "$here/consumer" "$here/../../docs/tutorial.md" "$root/trial"
inside apt-get -q update
inside sh -c 'apt-get install -y -q --no-install-recommends --reinstall /packages/*.deb \
  python3-paraview g++ cmake make pkg-config'

mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
inside bash -c 'cd /trial && bash in_clean_system.sh'
