# What clean_system.sh runs in the system where the packages are installed.
set -euxo pipefail
libraries="/usr/lib/$(uname -m)-linux-gnu"
newer=$(grep -q avx2 /proc/cpuinfo && echo glibc-hwcaps/x86-64-v3/ || true)

# The command, by either build.
mimetra sample -o head
mimetra convert head --weights head/performance.csv --frames 0:60:3 -o take.npy
for build in "" "$libraries/mimetra/x86-64/"; do
  "${build}mimetra" transfer take.npy head@identity001=1 -k 5 -o moved.npy --regions-out rois/take.pvd --force
done
mimetra render take.npy rois/take.pvd moved.npy --color none,region,none -o strip.png
mimetra report moved.npy -o report.html
[ "$(wc -c <report.html)" -gt 100000 ]
[ -s /usr/share/man/man1/mimetra.1.gz ]

# The commands of the tutorial.
mkdir tutorial
(cd tutorial && bash -ex <(awk '/^```sh$/ { on = 1; next } /^```$/ { on = 0 } on' ../tutorial.md))
[ -s tutorial/report.html ]

# No program or library looks for others where it was built.
for file in /usr/bin/mimetra "$libraries"/mimetra/x86-64*/mimetra "$libraries"/libmimetra_*.so.1 \
  "$libraries"/mimetra/*.so; do
  readelf -d "$file" | { ! grep -E 'R(UN)?PATH'; }
done

# The Python module, with the build for the processor, with and without pictures.
for name in c pictures; do
  MIMETRA_LIBRARY="$([ "$name" = pictures ] || echo libmimetra_c.so.1)" \
    python3 - "$libraries/${newer}libmimetra_$name.so.1" <<'PYTHON'
import sys
import mimetra
assert mimetra.sample().out.neutral.shape[1] == 3
assert sys.argv[1] in open("/proc/self/maps").read(), sys.argv[1]
if "pictures" in sys.argv[1]:
    assert mimetra.render(["take.npy"], columns=2).out.pixels.std() > 10
PYTHON
done

# ParaView's plugin.
PV_PLUGIN_PATH="$(dirname "$libraries"/paraview-*/plugins/Mimetra/Mimetra.so)" pvpython - \
  "$libraries/mimetra/${newer}libmimetra_paraview.so" <<'PYTHON'
import sys
from paraview.simple import *
take = mimetraSequence(FileName="moved.npy")
take.UpdatePipeline()
assert take.GetDataInformation().GetNumberOfPoints() > 1000
assert sys.argv[1] in open("/proc/self/maps").read(), sys.argv[1]
PYTHON

# Blender's add-on.
blender -b --factory-startup --python-exit-code 1 --python-expr "
import addon_utils, bpy
addon_utils.enable('mimetra_blender')
assert bpy.ops.mimetra.sample() == {'FINISHED'}
assert len(bpy.data.objects) > 3"

# Programs with the C interface, and with a static library.
cc version.c -o version $(pkg-config --cflags --libs mimetra)
./version
cmake -S consumer -B build -DCOMPONENTS=geodesic
cmake --build build
ctest --test-dir build --output-on-failure --no-tests=error
