"""The script that `mimetra regions --paraview` writes, without the plugin; needs a display."""

import ast
import re
import sys
import unittest

from vtkmodules.vtkIOImage import vtkPNGReader

from host import *


class View(HostTest):
    def test_opens_a_series_of_any_name(self):
        script = self.sample / "name.py"
        series = self.sample / "\u00e9 \U0001f600.pvd"
        mimetra("regions", self.sample.take, "-k", 2, "-o", series, "--paraview", script)
        opened = re.search(r"OpenDataFile\((.*)\)", script.read_text(encoding="utf-8")).group(1)
        self.assertEqual(ast.literal_eval(opened), str(series))

    def test_draws_every_region_in_its_colour_beside_a_legend(self):
        script = self.sample / "it's a \"view\".py"
        mimetra("regions", self.sample.take, "-k", 6, "-o", self.sample / "six.pvd", "--paraview",
                script)
        picture = self.sample / "view.png"
        done = subprocess.run([os.environ["PVPYTHON"], str(script), str(picture)],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        reader = vtkPNGReader()
        reader.SetFileName(str(picture))
        reader.Update()
        self.assertEqual(reader.GetOutput().GetDimensions(), (1280, 800, 1))
        pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3].astype(int)

        text = script.read_text()
        numbers = re.search(r"IndexedColors = \[(.*)\]", text).group(1).split(",")
        colors = np.round(255 * np.array(numbers, float)).astype(int).reshape(-1, 3)
        regions = json.loads(mimetra("regions", self.sample.take, "-k", 6, "-o",
                                     self.sample / "six.json", "--json"))["regions"]
        self.assertEqual(len(colors), 1 + len(regions))
        # The legend shows the colours themselves; light changes them on the face.
        for color in colors:
            self.assertGreater((np.abs(pixels - color).max(axis=1) <= 2).sum(), 50, color)
        self.assertGreater((pixels == 255).all(axis=1).mean(), 0.3)

        # Light changes from one pixel of the head to the next: within a face that is lit as a whole
        # it would not, and most neighbours lie in one.
        rows = pixels.reshape(800, 1280, 3)[:, :900]
        head = (rows != 255).any(axis=2)
        beside = head[:, 1:] & head[:, :-1]
        alike = (rows[:, 1:] == rows[:, :-1]).all(axis=2)
        self.assertLess(alike[beside].mean(), 0.4)


if __name__ == "__main__":
    run_tests()
