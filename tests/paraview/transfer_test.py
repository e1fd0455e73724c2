"""Region Transfer: the meshes of `mimetra transfer`, for models and for meshes as target."""

import csv
import unittest

from host import *


class RegionTransfer(HostTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.model = f"{cls.sample.head}@identity002=1"
        cls.target = cls.sample / "target.ply"
        mimetra("convert", cls.model, "-o", cls.target)

    def source(self):
        return simple.mimetraSequence(FileName=str(self.sample.take))

    def times(self):
        source = self.source()
        source.UpdatePipelineInformation()
        return list(source.TimestepValues)

    def transferred(self, name, target, *options):
        """What the command makes: positions, and the series of regions."""
        out, regions = self.sample / f"{name}.npy", self.sample / f"{name}.pvd"
        mimetra("transfer", self.sample.take, target, "-k", 12, "-o", out, "--regions-out", regions,
                *options)
        return np.load(out), at(simple.PVDReader(FileName=str(regions)), 0)

    def assert_frames(self, filter, expected):
        for time, frame in zip(self.times(), expected, strict=True):
            self.assert_same(points(at(filter, time)), frame, f"time {time}")

    def test_solves_for_blendshapes_as_the_command_does(self):
        weights = self.sample / "weights.csv"
        expected, regions = self.transferred("blendshapes", self.model, "--weights-out", weights)
        filter = simple.RegionTransfer(Input=self.source(), TargetFile=self.model, K=12)
        self.assert_frames(filter, expected)
        for name in ["region", "region_count", "roi"]:
            self.assert_same(point_array(at(filter, 0), name), point_array(regions, name), name)
        self.assert_same(cell_array(at(filter, 0), "in_L"), cell_array(regions, "in_L"))
        table = at(filter, port=1)
        with open(weights, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertGreater(len(rows[0]), 12)
        self.assert_table(table, rows)

    def test_solves_for_vertices_as_the_command_does(self):
        expected, _ = self.transferred("vertices", self.target)
        filter = simple.RegionTransfer(Input=self.source(), K=12,
                                       Target=simple.mimetraSequence(FileName=str(self.target)))
        self.assert_frames(filter, expected)
        self.assertEqual(at(filter, port=1).GetNumberOfColumns(), 0)

    def test_solves_for_vertices_of_a_model_where_asked(self):
        expected, _ = self.transferred("model_vertices", self.model, "--space", "vertex",
                                       "--outside", "identity")
        filter = simple.RegionTransfer(Input=self.source(), TargetFile=self.model, K=12,
                                       Space="vertex", Outside="identity")
        self.assert_frames(filter, expected)

    def test_uses_all_triangles_where_asked(self):
        out = self.sample / "full.npy"
        mimetra("transfer", self.sample.take, self.model, "--full", "-o", out)
        filter = simple.RegionTransfer(Input=self.source(), TargetFile=self.model, Full=1)
        self.assert_frames(filter, np.load(out))
        self.assertEqual(decompositions(filter), 0)
        self.assertIsNone(at(filter, 0).GetPointData().GetArray("roi"))

    def test_uses_a_region_set_from_a_file(self):
        regions = self.sample / "lips.json"
        mimetra("regions", self.sample.take, "-k", 4, "-o", regions)
        out = self.sample / "lips.npy"
        mimetra("transfer", self.sample.take, self.model, "--regions", regions, "-o", out)
        filter = simple.RegionTransfer(Input=self.source(), TargetFile=self.model,
                                       Regions=str(regions))
        self.assert_frames(filter, np.load(out))
        self.assertEqual(decompositions(filter), 0)

    def test_takes_a_point_array_as_how_much_of_the_motion_each_vertex_takes(self):
        source = self.source()
        count = at(source, 0).GetNumberOfPoints()
        weights = np.where(np.arange(count) < count // 3, 1.0, np.where(
            np.arange(count) < count // 2, 0.25, 0.0))
        listed, out = self.sample / "painted.txt", self.sample / "painted.npy"
        np.savetxt(listed, weights)
        regions = self.sample / "painted.pvd"
        mimetra("transfer", self.sample.take, self.model, "--paint", listed, "--falloff", "0.05",
                "-o", out, "--regions-out", regions)
        painted = simple.Calculator(
            Input=simple.GenerateIds(Input=source), ResultArrayName="lips",
            Function=f"if(PointIds < {count // 3}, 1, if(PointIds < {count // 2}, 0.25, 0))")
        filter = simple.RegionTransfer(Input=painted, TargetFile=self.model, Paint="field:lips",
                                       Falloff="0.05")
        self.assert_frames(filter, np.load(out))
        # Files hold fields in single precision.
        expected = point_array(at(simple.PVDReader(FileName=str(regions)), 0), "weight")
        np.testing.assert_allclose(point_array(at(filter, 0), "weight"), expected, atol=1e-7)
        between = np.count_nonzero((expected > 0) & (expected < 1))
        self.assertGreater(between, count // 2 - count // 3)
        self.assertEqual(decompositions(filter), 0)

    def test_decomposes_once_however_the_solution_changes(self):
        filter = simple.RegionTransfer(Input=self.source(), TargetFile=self.model, K=12)
        shown = [at(filter, time) for time in self.times()]
        filter.Ridge = 0.1
        self.assertFalse(np.array_equal(points(at(filter, 1)), points(shown[3])))
        filter.Radius = "0.05"
        at(filter, 0)
        filter.Ridge = 0  # a mesh has no weights
        filter.TargetFile = ""
        filter.Target = simple.mimetraSequence(FileName=str(self.target))
        at(filter, 0)
        self.assertEqual(decompositions(filter), 1)
        filter.SourceRest = "mean"
        at(filter, 0)
        self.assertEqual(decompositions(filter), 2)

    def test_passes_the_targets_data_through_without_its_normals(self):
        target = simple.GenerateIds(Input=simple.GenerateSurfaceNormals(
            Input=simple.mimetraSequence(FileName=str(self.target)), Splitting=0))
        given = at(target)
        self.assertIsNotNone(given.GetPointData().GetNormals())
        filter = simple.RegionTransfer(Input=self.source(), Target=target, K=12)
        shown = at(filter, 1)
        self.assertIsNone(shown.GetPointData().GetNormals())
        self.assert_same(point_array(shown, "PointIds"), point_array(given, "PointIds"))
        self.assert_same(cell_array(shown, "CellIds"), cell_array(given, "CellIds"))

    def test_takes_the_first_time_step_of_a_moving_target(self):
        still = simple.mimetraSequence(FileName=str(self.target))
        moving = simple.mimetraSequence(FileName=self.model, Weights=str(self.sample.weights))
        first = points(at(moving, 0))
        self.assertFalse(np.array_equal(first, points(at(moving, 2))))
        filter = simple.RegionTransfer(Input=self.source(), Target=moving, Full=1)
        expected = simple.RegionTransfer(Input=self.source(), Target=still, Full=1)
        # The target file is in single precision.
        np.testing.assert_allclose(points(at(filter, 2)), points(at(expected, 2)), atol=1e-5)

    def test_goes_on_into_other_filters(self):
        filter = simple.RegionTransfer(Input=self.source(), TargetFile=self.model, K=12)
        regions = simple.RegionsofInterest(Input=filter, K=5)
        self.assertEqual(point_array(at(regions, 1), "region").max(), 4)
        self.assertEqual(decompositions(filter), 1)
        self.assertEqual(decompositions(regions), 1)

    def test_takes_the_file_where_there_is_a_mesh_at_the_port_too(self):
        out = self.sample / "file.npy"
        mimetra("transfer", self.sample.take, self.model, "--full", "-o", out)
        filter = simple.RegionTransfer(Input=self.source(), Full=1,
                                       Target=simple.mimetraSequence(FileName=str(self.target)))
        still = points(at(filter, 1))
        filter.TargetFile = self.model
        self.assert_frames(filter, np.load(out))
        filter.TargetFile = ""
        self.assert_same(points(at(filter, 1)), still)

    def test_says_that_there_is_no_target(self):
        with Messages() as messages:
            shown = at(simple.RegionTransfer(Input=self.source()), 0)
        self.assertEqual(shown.GetNumberOfPoints(), 0)
        self.assertIn("Target: expected a mesh at the port Target, or a model as Target File",
                      messages.text)


if __name__ == "__main__":
    run_tests()
