"""mimetra Sequence: every format as the command reads it."""

import unittest

from host import *


class MimetraSequence(HostTest):
    def assert_frames(self, source, expected):
        source.UpdatePipelineInformation()
        times = list(source.TimestepValues)
        for time, frame in zip(times, expected, strict=True):
            self.assert_same(points(at(source, time)), frame)
        return times

    def test_reads_an_array_with_its_times(self):
        times = self.assert_frames(simple.mimetraSequence(FileName=str(self.sample.take)),
                                   np.load(self.sample.take))
        np.testing.assert_allclose(times, np.arange(12) / 3)

    def test_gives_times_to_an_array_that_has_none(self):
        bare = self.sample / "bare.npy"
        np.save(bare, np.load(self.sample.take))
        source = simple.mimetraSequence(FileName=str(bare), Fps="25",
                                        Topology=str(self.sample / "take.topology.ply"))
        times = self.assert_frames(source, np.load(self.sample.take))
        np.testing.assert_allclose(times, np.arange(12) / 25)

    def test_reads_a_model_with_weights(self):
        source = simple.mimetraSequence(FileName=f"{self.sample.head}@identity001=1",
                                        Weights=str(self.sample.weights), Frames=FRAMES)
        times = self.assert_frames(source, np.load(self.sample.take))
        np.testing.assert_allclose(np.diff(times), 1 / 3)

    def test_reads_a_folder_of_meshes(self):
        folder = self.sample / "frames"
        mimetra("convert", self.sample.take, "-o", folder, "--format", "obj", "--double")
        self.assert_frames(simple.mimetraSequence(FileName=str(folder)), np.load(self.sample.take))

    def test_reads_a_series_with_its_fields(self):
        pvd = self.sample / "regions.pvd"
        mimetra("regions", self.sample.take, "-k", 5, "-o", pvd)
        series = simple.PVDReader(FileName=str(pvd))
        source = simple.mimetraSequence(FileName=str(pvd))
        for name in ["region", "roi"]:
            self.assert_same(point_array(at(source, 1), name), point_array(at(series, 1), name))
        self.assert_same(cell_array(at(source, 1), "in_L"), cell_array(at(series, 1), "in_L"))

    def test_is_one_mesh_without_times_for_one_mesh(self):
        source = simple.mimetraSequence(FileName=str(self.sample.head))
        source.UpdatePipelineInformation()
        self.assertEqual(len(source.TimestepValues), 0)
        self.assertGreater(at(source).GetNumberOfPolys(), 4000)

    def test_knows_the_rest_pose_of_what_a_filter_leaves(self):
        source = simple.mimetraSequence(FileName=f"{self.sample.head}@identity001=1",
                                        Weights=str(self.sample.weights), Frames="30:120:10")
        side = simple.Calculator(Input=source, Function="mimetra_rest_X")
        half = simple.ExtractSurface(Input=simple.Threshold(
            Input=side, Scalars=["POINTS", "Result"], LowerThreshold=0, UpperThreshold=1e9))
        found = at(simple.RegionsofInterest(Input=half, K=2), source.TimestepValues[0])
        self.assertLess(found.GetNumberOfPoints(), at(source).GetNumberOfPoints())
        moved = (points(found) - point_array(found, "mimetra_rest")).astype(np.float32)
        self.assertGreater(np.abs(moved).max(), 0)
        self.assert_same(point_array(found, "displacement"), moved)

    def test_keeps_polygons(self):
        mesh = self.sample / "pentagon.obj"
        mesh.write_text("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv -1 1 0\nv 0 0 1\n"
                        "f 1 2 3 4 5\nf 1 2 6\n")
        offsets, corners = polygons(at(simple.mimetraSequence(FileName=str(mesh))))
        self.assertEqual(list(offsets), [0, 5, 8])
        self.assertEqual(list(corners), [0, 1, 2, 3, 4, 0, 1, 5])

    def test_is_what_opens_an_array(self):
        source = simple.OpenDataFile(str(self.sample.take))
        self.assertEqual(source.GetXMLLabel(), "mimetra Sequence Reader")
        self.assert_frames(source, np.load(self.sample.take))

    def test_shows_what_is_wrong_in_the_words_of_the_library(self):
        broken = self.sample / "broken.npy"
        broken.write_bytes(b"\x93NUMPY")
        cases = [(self.sample / "missing.npy", "no such file"), (broken, "broken.npy: "),
                 (f"{self.sample.head}@identity9=1", "identity9")]
        for name, words in cases:
            with Messages() as messages:
                shown = at(simple.mimetraSequence(FileName=str(name)))
            self.assertEqual(shown.GetNumberOfPoints(), 0)
            self.assertIn(words, messages.text)
            self.assertEqual(messages.text.count("ERROR"), 1, messages.text)

    def test_says_which_weights_were_not_known(self):
        weights = self.sample / "odd.csv"
        weights.write_text("time,jawOpen,ears\n0,0,0\n0.1,1,1\n")
        with Messages() as messages:
            at(simple.mimetraSequence(FileName=str(self.sample.head), Weights=str(weights)), 0)
        self.assertIn("ears", messages.text)


if __name__ == "__main__":
    run_tests()
