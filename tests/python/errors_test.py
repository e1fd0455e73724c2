"""What goes wrong: the class tells the command's exit code, the text is the library's."""

import unittest

import mimetra
import numpy as np
from sample import SampleTest

TRIANGLE = np.array([[0, 1, 2]])


class Errors(SampleTest):
    def assert_fails(self, kind, status, text, call):
        with self.assertRaisesRegex(kind, text) as caught:
            call()
        self.assertEqual(caught.exception.status, status)
        self.assertIsInstance(caught.exception, mimetra.Error)

    def test_a_value_out_of_range_is_wrong_usage(self):
        self.assert_fails(mimetra.UsageError, 2, "whole number of at least 1, found '0'",
                          lambda: mimetra.regions(self.arrays, k=0))

    def test_a_missing_file_is_bad_input(self):
        self.assert_fails(mimetra.BadInput, 3, "nothing/: no such file or folder",
                          lambda: mimetra.transfer(self.arrays, "nothing/"))

    def test_a_face_past_the_last_vertex_is_bad_input(self):
        self.assert_fails(mimetra.BadInput, 3, "face 0 uses vertex 2, expected 0 to 1",
                          lambda: mimetra.Sequence(np.zeros((2, 3)), TRIANGLE))

    def test_a_position_that_is_no_number_is_bad_input(self):
        poses = np.zeros((2, 3, 3))
        poses[1, 2, 0] = np.nan
        self.assert_fails(mimetra.BadInput, 3, "nan", lambda: mimetra.Sequence(poses, TRIANGLE))

    def test_another_topology_is_a_mismatch(self):
        mesh = (np.eye(3), TRIANGLE)
        self.assert_fails(mimetra.Mismatch, 4, "target: 3 vertices, expected 5126 as in the source",
                          lambda: mimetra.transfer(self.arrays, mesh))

    def test_arrays_of_the_wrong_shape_or_type_are_wrong_usage(self):
        for text, call in [
                ("rest", lambda: mimetra.Sequence(np.zeros((2, 3, 3)), TRIANGLE, rest=[[1, 2, 3]])),
                ("expected integers, found float64",
                 lambda: mimetra.Sequence(np.zeros((3, 3)), TRIANGLE + 0.5)),
                ("integers of 32 bits", lambda: mimetra.Sequence(np.zeros((3, 3)), TRIANGLE << 40)),
                ("expected numbers", lambda: mimetra.Sequence([["a"]], TRIANGLE)),
                ("expected 1 to 4 dimensions, found 0", lambda: mimetra.Sequence(1.0, TRIANGLE)),
                ("120 x 9, expected F x N x 3",
                 lambda: mimetra.Sequence(np.zeros((120, 9)), TRIANGLE)),
                ("faces: expected triangles T x 3 or a list of polygons, found None",
                 lambda: mimetra.Sequence(np.zeros((3, 3)), None)),
                ("list of polygons", lambda: mimetra.Sequence(np.zeros((3, 3)), [[[0, 1, 2]]])),
                ("booleans or uint8", lambda: mimetra.Regions(np.ones((1, 3)), TRIANGLE))]:
            with self.subTest(text), self.assertRaisesRegex(mimetra.Error, text) as caught:
                call()
            self.assertIn(caught.exception.status, (2, 3, 4))

    def test_a_value_of_another_kind_is_told_of(self):
        table = mimetra.Table({"k": [1.0]})
        self.assert_fails(mimetra.UsageError, 2, "expected the kind 'sequence', found 'table'",
                          lambda: mimetra.regions(table))
        self.assert_fails(mimetra.UsageError, 2, "found 'sequence'; a pose and its faces are a model",
                          lambda: mimetra.transfer(self.arrays, self.arrays))
        with self.assertRaisesRegex(TypeError, "expected a mimetra.Sequence, positions and faces or"
                                               " a path, found int"):
            mimetra.regions(3)
        with self.assertRaisesRegex(TypeError, "expected a mimetra.Components or a path"):
            mimetra.regions(self.arrays, components=3)

    def test_unknown_options_are_told_of_by_the_functions_name(self):
        with self.assertRaisesRegex(TypeError, r"regions\(\) got an unexpected keyword .*'kk'"):
            mimetra.regions(self.arrays, kk=3)
        with self.assertRaisesRegex(TypeError, r"'K'; did you mean 'k'\?"):
            mimetra.regions(self.arrays, K=3)
        with self.assertRaisesRegex(TypeError, r"'verbose'$"):
            mimetra.info(self.arrays, verbose=True)
        with self.assertRaisesRegex(TypeError, r"transfer\(\) missing a required .*'target'"):
            mimetra.transfer(self.arrays)

    def test_parameters_of_reading_need_an_input_that_is_read(self):
        for name, value in [("frames", "0:2"), ("fps", 25)]:
            self.assert_fails(mimetra.UsageError, 2, f"parameter '{name}' is about files",
                              lambda: mimetra.info(self.arrays, **{name: value}))
        self.assert_fails(mimetra.UsageError, 2, "parameter 'frames' is about files",
                          lambda: mimetra.transfer(self.arrays, self.actor, full=True,
                                                   frames="0:2"))
        self.assertEqual(mimetra.info(self.take, frames="0:2").report["frames"], 2)

    def test_parameters_of_writing_need_an_output_that_is_written(self):
        self.assert_fails(mimetra.UsageError, 2, "parameter 'format' is about files",
                          lambda: mimetra.align(self.arrays, format="obj"))

    def test_a_view_of_paraview_needs_the_file_that_it_shows(self):
        with self.assertRaisesRegex(mimetra.UsageError, "paraview: needs regions that ParaView"):
            mimetra.regions(self.arrays, paraview=True)

    def test_an_unknown_array_is_told_of_beside_those_there_are(self):
        with self.assertRaisesRegex(AttributeError, "no array 'points'; there are positions,"):
            self.arrays.points
        with self.assertRaises(KeyError):
            self.arrays["points"]

    def test_after_an_error_the_next_call_works(self):
        with self.assertRaises(mimetra.UsageError):
            mimetra.regions(self.arrays, k=0)
        self.assertEqual(len(mimetra.regions(self.arrays, k=2).out.masks), 2)


if __name__ == "__main__":
    unittest.main()
