#!/usr/bin/env bash
# scripts_test.sh SAMPLES: scripts without arguments say what they need, and a folder of somebody
# else's is left as it is.
set -euo pipefail
samples=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail() {
  echo "$1" >&2
  exit 1
}
# says CODE TEXT COMMAND...
says() {
  local expected=$1 text=$2 code=0
  shift 2
  "$@" >said 2>&1 || code=$?
  [ $code -eq "$expected" ] || fail "$*: expected exit code $expected, found $code: $(cat said)"
  grep -qF "$text" said || fail "$*: expected '$text', found: $(cat said)"
}

says 2 "usage: demo.sh MIMETRA OUT" "$samples/demo.sh"
says 2 "usage: fit.sh MIMETRA OUT" "$samples/fit.sh"
says 2 "usage: paraview_pictures.sh MIMETRA FOLDER_OF_MIMETRA_SO OUT" "$samples/paraview_pictures.sh"
says 2 "CLIPS is not set" bash "$samples/cluster/clips.slurm"
says 2 "usage: clips_by_dask.py" python3 "$samples/cluster/clips_by_dask.py"

mkdir own
echo dear >own/file
says 5 "own exists" "$samples/demo.sh" true own
says 5 "own exists" "$samples/fit.sh" true own
says 5 "own exists" "$samples/paraview_pictures.sh" /bin/true . own
[ "$(cat own/file)" = dear ] || fail "a file of somebody else's is gone"
mkdir empty
"$samples/demo.sh" true empty >/dev/null || fail "an empty folder is refused"
# What a run of the same script has left is replaced.
"$samples/demo.sh" true made >/dev/null
touch made/old
"$samples/demo.sh" true made >/dev/null
[ ! -e made/old ] || fail "what an earlier run had left is still there"
