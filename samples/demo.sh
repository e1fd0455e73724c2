#!/usr/bin/env bash
# The main job on the built-in sample: regions of one head's performance, and the performance on
# another head, by all triangles and by regions.  usage: demo.sh MIMETRA OUT
set -euo pipefail
[ $# -eq 2 ] || { echo "usage: demo.sh MIMETRA OUT" >&2; exit 2; }
. "$(dirname "$0")/own_folder.sh"
mimetra=$1
out=$2
own_folder "$out"

"$mimetra" sample -o "$out/head"
"$mimetra" convert "$out/head@identity001=1" --weights "$out/head/performance.csv" -o "$out/source"
"$mimetra" transfer "$out/source" "$out/head@identity002=1" --full -o "$out/full"
"$mimetra" transfer "$out/source" "$out/head@identity002=1" -k 30 -o "$out/regions" \
  --regions-out "$out/regions.pvd"
echo
echo "Table I of the paper on the sample (MPE in percent, negative is worse than full):"
"$mimetra" evaluate "$out/source" "$out/head@identity002=1" -k 10,30,40 -o "$out/table.json"

"$mimetra" render "$out/source" "$out/regions.pvd" "$out/full" "$out/regions" "$out/full" \
  --color none,region,none,none,difference --at 0,17,34,51,68,85,102 --unit mm \
  --titles "source,regions of the source that move,target by all triangles,target by these regions only,distance between the two" \
  -o "$out/strip.png"

"$mimetra" report "$out/regions" --unit mm -o "$out/report.html"

cat <<TEXT

What to open:
  $out/report.html  in a browser: source and target (in 3D where npm was there), components, error
  $out/strip.png    source, regions, and the target both ways, as a film strip
  $out/regions.pvd  in ParaView: press Apply, colour by 'region' or 'roi', press Play
  $out/source/      the performance of one head, frame_0000.ply on
  $out/full/        the same on another head, by all triangles
  $out/regions/     the same by 30 regions
  $out/table.json   error and time against the number of regions
TEXT
