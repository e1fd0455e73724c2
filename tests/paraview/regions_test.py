"""Regions of Interest: the fields of `mimetra regions`, over time, computed once."""

import unittest

from host import *


class RegionsOfInterest(HostTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.pvd = cls.sample / "regions.pvd"
        mimetra("regions", cls.sample.take, "-k", 12, "-o", cls.pvd)

    def take(self):
        return simple.mimetraSequence(FileName=str(self.sample.take))

    def filter_of(self, source, **properties):
        return simple.RegionsofInterest(Input=source, K=12, **properties)

    def assert_command_fields(self, found, expected):
        for name in ["region", "region_count", "roi", "displacement", "displacement_length"]:
            self.assert_same(point_array(found, name), point_array(expected, name), name)
        for name in ["in_L", "region_color"]:
            self.assert_same(cell_array(found, name), cell_array(expected, name), name)

    def test_has_the_fields_of_the_command_at_every_time(self):
        expected = simple.PVDReader(FileName=str(self.pvd))
        expected.UpdatePipelineInformation()
        found = self.filter_of(self.take())
        times = list(expected.TimestepValues)
        self.assertEqual(len(times), 12)
        for time in times:
            self.assert_command_fields(at(found, time), at(expected, time))

    def test_takes_a_series_of_another_reader(self):
        series = simple.PVDReader(FileName=str(self.pvd))
        series.UpdatePipelineInformation()
        again = self.sample / "again.pvd"
        mimetra("regions", self.pvd, "-k", 12, "-o", again)
        expected = simple.PVDReader(FileName=str(again))
        found = self.filter_of(series)
        for time in series.TimestepValues:
            self.assert_command_fields(at(found, time), at(expected, time))
            self.assert_same(points(at(found, time)), points(at(series, time)))
            for given, kept in zip(polygons(at(series, time)), polygons(at(found, time))):
                self.assert_same(kept, given)

    def test_takes_a_series_of_mesh_files(self):
        folder = self.sample / "frames"
        mimetra("convert", self.sample.take, "-o", folder)
        # The mesh files alone, as other tools write them, hold no rest pose.
        (self.sample / "frames.rest.ply").unlink()
        pvd = self.sample / "frames.pvd"
        mimetra("regions", folder, "-k", 12, "-o", pvd)
        series = simple.PLYReader(FileNames=sorted(map(str, folder.glob("*.ply"))))
        found = self.filter_of(series)
        expected = simple.PVDReader(FileName=str(pvd))
        for step in range(12):
            self.assert_command_fields(at(found, step), at(expected, step / 3))
            self.assert_same(points(at(found, step)), points(at(expected, step / 3)))
        self.assertEqual(decompositions(found), 1)

    def test_decomposes_once_however_the_time_and_the_shown_regions_change(self):
        series = simple.PVDReader(FileName=str(self.pvd))
        series.UpdatePipelineInformation()
        found = self.filter_of(series)
        for time in reversed(series.TimestepValues):
            at(found, time)
        for shown in [0, 3, -1]:
            found.DisplayedRegion = shown
            at(found, 0)
        found.Radius = "0.05"
        small = point_array(at(found, 0), "roi").sum()
        found.Radius = "0.2"
        self.assertGreater(point_array(at(found, 0), "roi").sum(), small)
        found.Coverage = "0.3"
        at(found, 0)
        self.assertEqual(decompositions(found), 1)

    def test_decomposes_again_for_other_parameters_and_other_input(self):
        source = self.take()
        found = self.filter_of(source)
        at(found, 0)
        found.K = 5
        self.assertEqual(point_array(at(found, 0), "region").max(), 4)
        self.assertEqual(decompositions(found), 2)
        source.Frames = "0:6"
        at(found, 0)
        self.assertEqual(decompositions(found), 3)

    def test_keeps_the_decomposition_where_the_input_is_made_again_alike(self):
        source = self.take()
        found = self.filter_of(source)
        at(found, 0)
        source.Frames = "0:12"
        at(found, 0)
        self.assertEqual(decompositions(found), 1)

    def test_is_the_same_when_a_parameter_returns_to_its_default(self):
        found = self.filter_of(self.take(), Radius="0.05")
        at(found, 0)
        found.Radius = "0.1"
        expected = simple.PVDReader(FileName=str(self.pvd))
        self.assert_command_fields(at(found, 0), at(expected, 0))

    def test_takes_components_from_a_file(self):
        components = self.sample / "components.h5"
        if not components.exists():
            mimetra("decompose", self.sample.take, "-k", 12, "-o", components)
        found = self.filter_of(self.take(), Components=str(components))
        expected = simple.PVDReader(FileName=str(self.pvd))
        self.assert_command_fields(at(found, 0), at(expected, 0))
        self.assertEqual(decompositions(found), 0)

    def test_shows_one_region_with_what_others_cover(self):
        shown = at(self.filter_of(self.take(), DisplayedRegion=2), 0)
        mask = point_array(shown, "displayed_region")
        self.assertEqual(set(mask), {0, 1})
        self.assertTrue((mask[point_array(shown, "region") == 2] == 1).all())
        self.assertTrue((point_array(shown, "roi")[mask == 1] == 1).all())

    def test_passes_point_and_cell_data_through(self):
        mesh = at(self.take(), 0)
        numbers = simple.GenerateIds(Input=self.take())
        found = at(self.filter_of(numbers), 0)
        given = at(numbers, 0)
        for i in range(given.GetPointData().GetNumberOfArrays()):
            name = given.GetPointData().GetArrayName(i)
            self.assert_same(point_array(found, name), point_array(given, name), name)
        for i in range(given.GetCellData().GetNumberOfArrays()):
            name = given.GetCellData().GetArrayName(i)
            self.assert_same(cell_array(found, name), cell_array(given, name), name)
        self.assert_same(points(found), points(mesh))

    def region_of(self, source):
        return point_array(at(self.filter_of(source), 0), "region").copy()

    def test_are_the_same_wherever_a_transform_brings_the_head(self):
        take = self.take()
        time = take.TimestepValues[-1]
        plain = at(self.filter_of(take), time)
        region, length = [point_array(plain, n) for n in ["region", "displacement_length"]]
        moves = [{"Translate": [0.5, 0, 0]}, {"Translate": [300, -20, 5]}, {"Rotate": [0, 0, 30]},
                 {"Translate": [0, 40, 0], "Rotate": [20, 50, 10], "Scale": [2, 2, 2]}]
        for move in moves:
            for with_vectors in [1, 0]:
                moved = simple.Transform(Input=take, TransformAllInputVectors=with_vectors)
                moved.Transform = "Transform"
                for name, value in move.items():
                    setattr(moved.Transform, name, value)
                with Messages() as messages:
                    found = at(self.filter_of(moved), time)
                self.assertEqual(messages.text, "")
                scale = move.get("Scale", [1])[0]
                np.testing.assert_allclose(point_array(found, "displacement_length"),
                                           scale * length, rtol=1e-5, atol=1e-7 * length.max())
                # Between two regions that reach a vertex alike, rounding decides.
                self.assertLessEqual((point_array(found, "region") != region).sum(), 2)

    def test_says_where_the_rest_pose_stays_behind(self):
        bent = simple.Calculator(Input=self.take(), CoordinateResults=1,
                                 Function="coords+iHat*0.01*coordsY*coordsY")
        with Messages() as messages:
            at(self.filter_of(bent), 0)
        self.assertEqual(messages.text.count("not as a whole"), 1, messages.text)
        self.assertIn("mimetra_rest", messages.text)
        # In the first frame it moves nothing.
        warped = simple.WarpByVector(Input=self.filter_of(self.take()))
        warped.Vectors = ["POINTS", "displacement"]
        with Messages() as messages:
            at(self.filter_of(warped), 0)
        self.assertEqual(messages.text.count("not as a whole"), 1, messages.text)

    def with_motion(self, name):
        """A series of frames without a rest pose, with the motion to the next ones as an array."""
        frames = np.load(self.sample.take)
        faces = at(self.take(), 0)
        meshes = []
        for i, frame in enumerate(frames):
            mesh = vtkPolyData()
            mesh.ShallowCopy(mesh_of(frame, []))
            mesh.SetPolys(faces.GetPolys())
            motion = numpy_to_vtk(frames[min(i + 3, len(frames) - 1)] - frame, deep=True)
            motion.SetName(name)
            mesh.GetPointData().AddArray(motion)
            meshes.append(mesh)
        return self.series_of(name, meshes)

    def test_takes_no_array_of_others_for_the_rest_pose(self):
        expected = self.region_of(self.with_motion("motion"))
        with Messages() as messages:
            found = self.region_of(self.with_motion("displacement"))
        self.assert_same(found, expected)
        self.assertIn("not passed on: displacement;", messages.text)
        again = self.sample / "again_displacement.pvd"
        mimetra("regions", self.sample / "displacement.pvd", "-k", 12, "-o", again)
        series = simple.PVDReader(FileName=str(again))
        self.assert_same(point_array(at(series, 0), "region"), expected)

    def test_names_the_arrays_that_it_replaces(self):
        numbered = simple.Calculator(Input=self.take(), Function="coordsX", ResultArrayName="roi")
        found = self.filter_of(numbered)
        with Messages() as messages:
            at(found, 0)
            at(found, 1)
        self.assertEqual(messages.text.count("not passed on: roi;"), 1,
                         messages.text)

    def test_passes_on_in_silence_what_the_command_wrote_of_displacements(self):
        written = self.sample / "moved.pvd"
        mimetra("convert", self.sample.take, "-o", written)
        series = simple.PVDReader(FileName=str(written))
        self.assertTrue(at(series, 0).GetPointData().HasArray("displacement"))
        with Messages() as messages:
            at(self.filter_of(series), 0)
        self.assertEqual(messages.text, "")

    def test_says_that_file_series_count_frames(self):
        folder = self.sample / "counted"
        mimetra("convert", self.sample.take, "-o", folder)
        files = simple.PLYReader(FileNames=sorted(map(str, folder.glob("*.ply"))))
        words = "its frames are 1 s apart (median)"
        with Messages() as messages:
            found = self.filter_of(files)
            at(found, 0)
            at(found, 5)
        self.assertEqual(messages.text.count(words), 1, messages.text)
        self.assertIn("Temporal Shift Scale", messages.text)
        seconds = simple.TemporalShiftScale(Input=files, Scale=1 / 30)
        with Messages() as messages:
            at(self.filter_of(seconds), 0)
        self.assertNotIn(words, messages.text)


if __name__ == "__main__":
    run_tests()
