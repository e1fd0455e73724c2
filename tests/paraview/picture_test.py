"""What the user sees of the regions; needs a display."""

import unittest

from vtkmodules.vtkIOImage import vtkPNGReader

from host import *


class Picture(HostTest):
    def picture(self, view, name, time):
        path = str(self.sample / f"{name}.png")
        view.ViewTime = time
        simple.SaveScreenshot(path, view, ImageResolution=[640, 480])
        reader = vtkPNGReader()
        reader.SetFileName(path)
        reader.Update()
        pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
        return pixels.reshape(480, 640, -1)[:, :, :3].astype(int)

    def shown_regions(self, colored_by):
        """The sequence, its regions, and how they are shown in a view of their own."""
        source = simple.mimetraSequence(FileName=str(self.sample.take))
        filter = simple.RegionsofInterest(Input=source, K=6)
        view = simple.CreateView("RenderView")
        display = simple.Show(filter, view)
        simple.ColorBy(display, colored_by)
        return source, filter, view, display

    def test_shows_regions_in_their_colours_over_time(self):
        source, _, view, display = self.shown_regions(("POINTS", "region"))
        display.RescaleTransferFunctionToDataRange()
        simple.ResetCamera(view)
        first = self.picture(view, "first", 0)
        is_head = np.abs(first - first[0, 0]).sum(axis=2) > 30
        self.assertTrue(0.05 < is_head.mean() < 0.95, is_head.mean())
        # Regions and the rest of the head differ in hue: red beside blue.
        reddish = is_head & (first[:, :, 0] > first[:, :, 2] + 30)
        bluish = is_head & (first[:, :, 2] > first[:, :, 0] + 30)
        self.assertGreater(min(reddish.mean(), bluish.mean()), 0.001)
        later = self.picture(view, "later", source.TimestepValues[5])
        self.assertTrue((first != later).any())
        simple.Delete(view)

    def test_shows_the_colours_of_pictures_where_no_scalars_are_mapped(self):
        _, filter, view, display = self.shown_regions(("CELLS", "region_color"))
        display.MapScalars = 0
        display.Ambient, display.Diffuse, display.Specular = 1, 0, 0
        simple.ResetCamera(view)
        pixels = self.picture(view, "colours", 0).reshape(-1, 3)
        regions = cell_array(at(filter, 0), "region_color")
        colors, faces = np.unique(regions, axis=0, return_counts=True)
        self.assertGreater(len(colors), 3)
        for color in colors[faces > 100]:
            self.assertGreater((pixels == color).all(axis=1).sum(), 20, color)
        simple.Delete(view)


if __name__ == "__main__":
    run_tests()
