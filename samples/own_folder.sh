# own_folder FOLDER: makes it, or empties what an earlier run of the same script left there; ends the
# script where it holds anything else.
own_folder() {
  local mark="$1/.${0##*/}"
  if [ -e "$1" ] && [ ! -e "$mark" ] && ! rmdir "$1" 2>/dev/null; then
    echo "${0##*/}: $1 exists, and is not from an earlier run; name another folder" >&2
    exit 5
  fi
  rm -rf "$1"
  mkdir -p "$1"
  touch "$mark"
}
