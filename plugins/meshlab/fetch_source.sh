#!/usr/bin/env bash
# fetch_source.sh FOLDER: the source of the installed MeshLab in FOLDER/source, where it is missing.
# Debian packages no headers of MeshLab, but its source has them. It comes from the archive that apt
# knows the package from, by lists and settings in FOLDER: the system's own stay as they are.
set -euo pipefail

fail() {
  echo "fetch_source.sh: $*" >&2
  exit 1
}

[ $# -eq 1 ] || fail "usage: fetch_source.sh FOLDER"
mkdir -p "$1"
folder="$(cd "$1" && pwd)"
version="$(dpkg-query -W -f='${source:Version}' meshlab 2>/dev/null)" ||
  fail "the package meshlab is not installed"
[ "$(cat "$folder/version" 2>/dev/null)" != "$version" ] || exit 0

rm -rf "$folder"/{source,version,sources,lists,cache}
mkdir -p "$folder"/{sources,lists/partial,cache/archives/partial}

# "meshlab | VERSION | URI RELEASE/COMPONENT ARCHITECTURE Packages", of each version that apt knows
installed="$(dpkg-query -W -f='${Version}' meshlab)"
archive="$(apt-cache madison meshlab |
  awk -F ' *[|] *' -v version="$installed" '$2 == version && / Packages$/ && !found++')"
[ -n "$archive" ] || fail "apt does not know where meshlab $installed comes from; try apt-get update"
read -r uri place _ <<<"${archive##*| }"

# The file that names this archive, with its keys and options, asks for sources instead of packages.
entry="$(apt-get indextargets --format '$(SOURCESENTRY)' \
  'Created-By: Packages' "Site: $uri" "Release: ${place%%/*}")"
entry="${entry%%$'\n'*}"
[ -f "${entry%:*}" ] || fail "no file of apt's names the archive $uri of meshlab"
sed -E 's/^deb([[:space:]])/deb-src\1/; s/^Types:.*/Types: deb-src/' "${entry%:*}" \
  >"$folder/sources/$(basename "${entry%:*}")"

# The hooks that follow an update work on the system's own files.
cat >"$folder/apt.conf" <<TEXT
Dir::Etc::SourceList "/dev/null";
Dir::Etc::SourceParts "$folder/sources";
Dir::State::Lists "$folder/lists";
Dir::Cache "$folder/cache";
APT::Sandbox::User "$(id -un)";
#clear APT::Update;
TEXT

own_apt_get() {
  apt-get -q -c "$folder/apt.conf" "$@"
}

cd "$folder"
# Another archive in the same file may hold no sources; what counts is whether meshlab is found.
own_apt_get update || true
own_apt_get source --download-only "meshlab=$version" ||
  fail "$uri did not give the source of meshlab $version; is there a network, or a newer meshlab?"
dpkg-source --no-check -x meshlab_*.dsc source
rm -rf apt.conf sources lists cache meshlab_*
echo "$version" >version
