#!/usr/bin/env bash
# The pictures of docs/paraview.md: a view that `regions --paraview` wrote, and ParaView's window with
# the plugin's filters. Needs what `./dev hosts` installs.
# usage: paraview_pictures.sh MIMETRA FOLDER_OF_MIMETRA_SO OUT
set -euo pipefail
[ $# -eq 3 ] || { echo "usage: paraview_pictures.sh MIMETRA FOLDER_OF_MIMETRA_SO OUT" >&2; exit 2; }
. "$(dirname "$0")/own_folder.sh"
mimetra=$(realpath "$1")
plugin=$(realpath "$2")
own_folder "$3"
mkdir -p "$3/settings/ParaView" "$3/screen"
cd "$3"

"$mimetra" sample -o head
"$mimetra" convert head@identity001=1 --weights head/performance.csv -o takes
"$mimetra" regions takes -k 30 -o rois/take.pvd --paraview rois/view.py
xvfb-run -a -n 220 -s "-screen 0 1280x1024x24 -noreset" pvpython rois/view.py view.png

{
  cat rois/view.py
  cat <<'PYTHON'
take = mimetraSequence(registrationName="takes", FileName="takes")
regions = RegionsofInterest(registrationName="Regions of Interest", Input=take, K=10)
Delete(time)
Delete(faces)
Delete(reader)
ColorBy(Show(regions, view), ("POINTS", "region"))
legend.Visibility = 0
SetActiveSource(regions)
GetAnimationScene().AnimationTime = 3.4
Render(view)
open("drawn", "w").close()
PYTHON
} >window.py
cat >settings/ParaView/ParaView5.11.0.ini <<'INI'
[General]
GeneralSettings.ShowWelcomeDialog=0
INI

# Xvfb keeps what its screen shows in a file, as an XWD image.
cat >show_window.sh <<'SHELL'
XDG_CONFIG_HOME="$PWD/settings" PV_PLUGIN_PATH="$1" paraview --script=window.py >window.log 2>&1 &
for _ in {1..60}; do
  test -e drawn && break
  sleep 1
done
sleep 3
cp screen/Xvfb_screen0 window.xwd
kill $!
SHELL
xvfb-run -a -n 230 -s "-screen 0 1152x764x24 -fbdir $PWD/screen" bash show_window.sh "$plugin" || true
test -e drawn || { cat window.log >&2; exit 1; }
pvpython - <<'PYTHON'
import struct
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

data = open("window.xwd", "rb").read()
header = struct.unpack(">25I", data[:100])
width, height, line = header[4], header[5], header[12]
pixels = numpy.frombuffer(data, numpy.uint8, line * height, header[0] + 12 * header[19])
pixels = pixels.reshape(height, line // 4, 4)[::-1, :width, 2::-1]
image = vtkImageData()
image.SetDimensions(width, height, 1)
image.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(-1, 3), deep=1))
writer = vtkPNGWriter()
writer.SetInputData(image)
writer.SetFileName("window.png")
writer.Write()
PYTHON
