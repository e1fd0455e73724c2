"""What cannot be computed: a message in the library's words, and no crash."""

import unittest

from host import *


class BadInput(HostTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        cls.points = write_ply(cls.path / "points.ply", cls.square, [])
        cls.one = write_ply(cls.path / "one.ply", cls.square, [(0, 1, 2), (0, 2, 3)])
        cls.other = write_ply(cls.path / "other.ply", cls.square, [(0, 1, 3), (1, 2, 3)])
        cls.quad = write_ply(cls.path / "quad.ply", cls.square, [(0, 1, 2, 3)])

    def test_points_without_faces(self):
        for name in OPERATIONS:
            values = {"source": "0"} if name == "Geodesic Support Map" else {}
            with self.subTest(filter=name):
                self.assert_refused([self.points] * 2, [filter_script(name, **values)],
                                    "layer 'points.ply' has no faces")

    def test_layers_of_other_vertices(self):
        self.assert_refused([self.target, self.one], [filter_script("Regions of Interest")],
                            "layer 'one.ply': 4 vertices, expected 5126 as in layer 'target.ply'; "
                            "hide layers that belong to another mesh")

    def test_layers_of_other_faces(self):
        self.assert_refused([self.one, self.other], [filter_script("Regions of Interest")],
                            "layer 'other.ply': face 0 is not that of layer 'one.ply'")
        self.assert_refused([self.one, self.quad], [filter_script("Regions of Interest")],
                            "layer 'quad.ply': 1 faces, expected 2")

    def test_a_sequence_of_other_faces_than_the_layer(self):
        script = filter_script("Regions of Interest", sequence=self.path / "take", k=3)
        self.assert_refused([self.one], [script],
                            "5126 vertices, expected 4 as in the current layer")

    def test_a_target_of_other_faces_than_the_source(self):
        script = filter_script("Region Transfer", source=self.path / "take", k=3)
        self.assert_refused([self.one], [script], "5126")

    def test_one_frame_where_motion_is_needed(self):
        self.assert_refused([self.one], [filter_script("Regions of Interest", k=2)],
                            "the sequence has one frame; a decomposition needs at least two")

    def test_no_frames_besides_the_target(self):
        self.assert_refused([self.one], [filter_script("Region Transfer")],
                            "there are no frames: show the layers that are the source, or name its "
                            "files")

    def test_a_path_that_is_not_there(self):
        script = filter_script("Regions of Interest", sequence=self.path / "nothing")
        self.assert_refused([self.one], [script], "nothing: no such file or folder")

    def test_a_value_out_of_its_range(self):
        self.assert_refused(self.take, [filter_script("Regions of Interest", k=0)], "found '0'")
        self.assert_refused(self.take, [filter_script("Regions of Interest", coverage=7)],
                            "expected a number from 1e-09 to 1, found '7'")
        self.assert_refused(self.take, [filter_script("Regions of Interest", region=9)],
                            "region: expected a choice from 0 to 1, found 9")

    def test_further_options_that_are_none(self):
        for options, words in [
                ("--rhoo 5", "expected an option such as --components-out, found '--rhoo'"),
                ("rho", "found 'rho'"), ("--signed 1", "found '1'"),
                ("--compress small", "found '--compress'"), ("--rho", "--rho needs a value"),
                ("--radius 0.2", "--radius has a row of its own"),
                ("--fps 30", "fps=30 is about files; name them as the sequence")]:
            with self.subTest(options=options):
                self.assert_refused(self.take, [filter_script("Regions of Interest",
                                                              options=options)], words)

    def test_an_output_that_exists(self):
        script = filter_script("Regions of Interest", k=3, options=f"--components-out {self.one}")
        self.assert_refused(self.take, [script], "one.ply: exists; choose another name")

    def test_an_output_that_cannot_be_written_costs_no_result(self):
        """The message comes when the layers are there."""
        out = self.path / "regions.pvd"
        script = filter_script("Region Transfer", k=3, target=self.model,
                               options=f"--regions-out {out}")
        done = self.serve(self.take, [script])
        self.assertEqual(done.returncode, 255, done.stdout + done.stderr)
        shown = done.stdout.index("12 frames are new, hidden layers")
        self.assertGreater(done.stdout.index("regions.pvd: regions can be written as"), shown)

    def test_a_vertex_that_is_not_there(self):
        self.assert_refused([self.one], [filter_script("Geodesic Support Map", source="4")],
                            "option 'source': vertex 4, the mesh has 4 (0-based)")


if __name__ == "__main__":
    unittest.main()
