#!/usr/bin/env bash
# Five pictures of the built-in head while it talks, and the head fitted to the faces that are found
# in them.  usage: fit.sh MIMETRA OUT
set -euo pipefail
[ $# -eq 2 ] || { echo "usage: fit.sh MIMETRA OUT" >&2; exit 2; }
. "$(dirname "$0")/own_folder.sh"
mimetra=$1
out=$2
own_folder "$out"

"$mimetra" sample -o "$out/head"
for frame in 17 28 42 51 68; do
  "$mimetra" render "$out/head@identity002=0.4" --weights "$out/head/performance.csv" --at $frame \
    --layout frame --yaw $((frame / 5 - 10)) --pitch 0 --size 640 -o "$out/images/$frame.png"
done
"$mimetra" fit "$out/images" --model "$out/head" -o "$out/fitted" \
  --overlay "$out/overlay" --strip "$out/strip.png"
