"""Values: arrays go in and come out as they are, and their memory lives as long as it is seen."""

import copy
import gc
import pickle
import unittest

import mimetra
import numpy as np
from sample import SampleTest

# A square of two triangles beside a quad, and a pose in which one vertex has moved.
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]], float)
POLYGONS = [[0, 1, 2], [0, 2, 3], [1, 4, 5, 2]]


def moved():
    poses = np.stack([CORNERS, CORNERS])
    poses[1, 3, 2] = 0.25
    return poses


class Values(SampleTest):
    def test_arrays_come_out_as_they_went_in(self):
        take = mimetra.Sequence(moved(), POLYGONS, times=[0, 0.5], rest=CORNERS, name="square")
        self.assertEqual(take.name, "square")
        self.assert_same(take.positions, moved())
        self.assert_same(take["times"], np.array([0, 0.5]))
        self.assert_same(take.rest, CORNERS)
        self.assertEqual(take.face_sizes.tolist(), [3, 3, 4])
        self.assertEqual(take.corners.tolist(), sum(POLYGONS, []))
        self.assertEqual(len(take.triangles), 4)

    def test_single_precision_and_strided_arrays_are_taken(self):
        poses = np.asfortranarray(moved().astype(np.float32))
        self.assert_same(mimetra.Sequence(poses, POLYGONS).positions, moved())
        twice = np.repeat(moved(), 2, axis=1)[:, ::2]
        self.assert_same(mimetra.Sequence(twice, POLYGONS).positions, moved())

    def test_what_a_mask_hides_is_missing(self):
        hidden = np.zeros((2, 1, 2), bool)
        hidden[1] = True
        points = np.ma.array(np.ones((2, 1, 2)), mask=hidden, fill_value=-9999)
        seen = mimetra.Landmarks(points, ["0"]).points
        self.assert_same(seen[0], np.ones((1, 2)))
        self.assertTrue(np.isnan(seen[1]).all())
        table = mimetra.Table({"x": np.ma.array([1, 777], mask=[False, True])})
        self.assertEqual(table["x"][0], 1)
        self.assertTrue(np.isnan(table["x"][1]))
        poses = np.ma.array(moved(), mask=False)
        self.assert_same(mimetra.Sequence(poses, POLYGONS).positions, moved())
        poses[1, 3, 2] = np.ma.masked
        for hidden in [poses, list(poses)]:
            with self.assertRaisesRegex(mimetra.BadInput, "positions"):
                mimetra.Sequence(hidden, POLYGONS)
        triangles = np.ma.array([[0, 1, 2]], mask=[[False, True, False]])
        with self.assertRaisesRegex(mimetra.UsageError, "masked"):
            mimetra.Sequence(moved(), triangles)

    def test_what_is_odd_about_a_value_is_said_where_it_is_made(self):
        with self.assertLogs("mimetra", "WARNING") as said:
            mimetra.Model(CORNERS, POLYGONS, np.full((1, 6, 3), 9.0), ["aside"], name="square")
        self.assertIn("square: expressions of another place, turn or size", said.output[0])
        with self.assertLogs("mimetra", "WARNING") as said:
            mimetra.Sequence(np.stack([CORNERS] * 12), POLYGONS, times=np.arange(12.0))
        self.assertIn("frames are 1 s apart (median)", said.output[0])

    def test_times_rise(self):
        for times in [[0, 0], [1, 0]]:
            with self.assertRaisesRegex(mimetra.BadInput, r"'times' holds 0 at \[1\]"):
                mimetra.Sequence(moved(), POLYGONS, times=times)
            with self.assertRaisesRegex(mimetra.BadInput, r"'times' holds 0 at \[1\]"):
                mimetra.Landmarks(np.ones((2, 1, 2)), ["0"], times=times)

    def test_faces_are_triangles_quads_lists_or_those_of_another_value(self):
        triangles = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int64)
        flat = mimetra.Sequence(CORNERS, triangles)
        self.assertEqual(flat.positions.shape, (1, 6, 3))
        self.assert_same(flat.triangles, triangles.astype(np.int32))
        quads = mimetra.Sequence(CORNERS, np.array([[0, 1, 2, 3], [1, 4, 5, 2]]))
        self.assertEqual(quads.face_sizes.tolist(), [4, 4])
        self.assertEqual(mimetra.Model(CORNERS, quads.faces).corners.tolist(),
                         quads.corners.tolist())

    def test_views_cannot_be_written_to_and_outlive_the_value(self):
        take = mimetra.Sequence(moved(), POLYGONS)
        positions = take.positions
        self.assertEqual(positions.ctypes.data, take.positions.ctypes.data)
        with self.assertRaises(ValueError):
            positions[0] = 0
        del take
        gc.collect()
        self.assert_same(np.array(positions), moved())

    def test_fields_on_vertices_and_on_triangles_may_share_a_name(self):
        fields = mimetra.Sequence(moved(), POLYGONS, on_vertices={"area": np.arange(6.0)},
                                  on_triangles={"area": [0, 0, 0, 1], "part": [0, 0, 1, 1]})
        self.assert_same(fields.area, np.arange(6.0))
        changed = fields.derive(part=[2, 2, 3, 3])
        self.assertEqual(changed.part.tolist(), [2, 2, 3, 3])
        self.assertEqual(changed.location("part"), "triangles")
        self.assert_same(changed.area, np.arange(6.0))

    def test_a_copy_is_the_value_itself(self):
        take = mimetra.Sequence(moved(), POLYGONS)
        copies = copy.copy(take), copy.deepcopy([take])[0]
        del take
        gc.collect()
        for each in copies:
            self.assert_same(np.array(each.positions), moved())

    def test_values_are_saved_not_pickled(self):
        with self.assertRaisesRegex(TypeError, "mimetra.Sequence cannot be pickled; save it"):
            pickle.dumps(mimetra.Sequence(moved(), POLYGONS))

    def test_formats_are_those_that_values_are_saved_in(self):
        formats = {ending: each for each in mimetra.formats for ending in each.extensions
                   if each.kind is mimetra.Sequence}
        self.assertTrue(formats[".npy"].read and formats[".npy"].written)
        self.assertIn("single", formats[".npy"].options)
        self.assertNotIn("format", formats[".npy"].options)
        with self.assertRaisesRegex(mimetra.UsageError, "format=obj"):
            mimetra.Sequence(moved(), POLYGONS).save(self.path / "take.npy", format="obj")

    def test_saving_names_the_fields_that_a_format_leaves_out(self):
        shown = mimetra.geodesic(self.arrays, source=[3]).out
        with self.assertLogs("mimetra", "WARNING") as logs:
            shown.save(self.path / "fields.npy")
        self.assertIn("holds no fields; without distance, support", logs.output[0])

    def test_fields_stand_on_vertices_or_triangles(self):
        value = mimetra.Sequence(
            moved(), POLYGONS, on_vertices={"heat": np.arange(6.0), "part": [0] * 5 + [1]},
            on_triangles={"inside": np.array([True, False, True, False])})
        self.assertEqual(value.location("heat"), "vertices")
        self.assertEqual(value.location("inside"), "triangles")
        self.assertIsNone(value.location("positions"))
        self.assert_same(value.heat, np.arange(6.0))
        self.assert_same(value.part, np.array([0, 0, 0, 0, 0, 1], np.int32))
        self.assert_same(value.inside, np.array([1, 0, 1, 0], np.int32))

    def test_a_model_keeps_names_and_expressions(self):
        shapes = np.stack([CORNERS, 2 * CORNERS])
        model = mimetra.Model(CORNERS, POLYGONS, shapes, ["open", "wide"])
        self.assert_same(model.expressions, shapes)
        self.assertEqual(model.expression_names, ["open", "wide"])

    def test_a_model_may_have_identities_and_a_performance(self):
        shapes = np.stack([CORNERS, 2 * CORNERS])
        model = mimetra.Model(CORNERS, POLYGONS, shapes, ["open", "wide"], 3 * shapes,
                              ["tall", "old"], weights=[[0, 0.5], [1, 0], [0, 1]],
                              weight_names=["open", "wide"], times=[0, 1, 2],
                              landmarks=[[31, 4], [8, 5]])
        self.assert_same(model.identities, 3 * shapes)
        self.assertEqual(model.identity_names, ["tall", "old"])
        self.assert_same(model.weights, np.array([[0, 0.5], [1, 0], [0, 1]]))
        self.assertEqual(model.weight_names, ["open", "wide"])
        self.assert_same(model.times, np.arange(3.0))
        self.assertEqual(model.landmarks.tolist(), [[31, 4], [8, 5]])
        alone = mimetra.Model(CORNERS, POLYGONS)
        self.assertNotIn("identities", alone)
        self.assertNotIn("weights", alone)

    def test_a_model_is_loaded_with_its_identities_or_as_one_of_them(self):
        model = mimetra.Model.load(self.head)
        person = mimetra.Model.load(f"{self.head}@identity002=1")
        self.assertNotIn("identities", person)
        shape = model.identities[model.identity_names.index("identity002")]
        np.testing.assert_allclose(person.neutral, model.neutral + shape, atol=1e-9)

    def test_pixels_and_text_come_out_as_they_went_in(self):
        pixels = np.arange(18, dtype=np.uint8).reshape(2, 3, 3)
        self.assert_same(mimetra.Pictures(pixels).pixels, pixels)
        self.assertEqual(mimetra.Document("a page").text, ["a page"])

    def test_masks_become_regions(self):
        masks = np.zeros((2, 6), bool)
        masks[0, :2] = masks[1, 5] = True
        regions = mimetra.Regions(masks, POLYGONS)
        self.assert_same(regions.masks, masks.view(np.uint8))
        self.assertEqual(regions.region.tolist(), [0, 0, -1, -1, -1, 1])

    def test_empty_cells_of_a_table_are_nan(self):
        table = mimetra.Table({"k": [1, 2], "error": [0.5, np.nan]})
        self.assertEqual(list(table), ["k", "error"])
        self.assert_same(table["error"], np.array([0.5, np.nan]))
        self.assertIn("null", table.json)

    def test_a_derived_value_keeps_the_arrays_it_was_not_given(self):
        take = mimetra.Sequence(moved(), POLYGONS, times=[0, 2])
        double = take.derive(positions=2 * moved())
        self.assert_same(double.positions, 2 * moved())
        self.assert_same(double.times, np.array([0.0, 2.0]))
        self.assertEqual(double.corners.tolist(), take.corners.tolist())

    def test_saving_then_loading_is_the_identity(self):
        path = self.path / "saved.npy"
        self.arrays.save(path)
        self.assert_same(mimetra.Sequence.load(path).positions, self.arrays.positions)
        part = mimetra.Sequence.load(path, frames="2:8:3")
        self.assert_same(part.positions, self.arrays.positions[2:8:3])
        self.assert_same(part["times"], self.arrays["times"][2:8:3])
        with self.assertRaisesRegex(mimetra.UsageError, "have times of their own.* and fps is for"):
            mimetra.Sequence.load(path, fps=10)
        with self.assertRaisesRegex(mimetra.OutputError, "saved.npy: exists already; use force to"):
            self.arrays.save(path)
        self.arrays.save(path, force=True, single=True)
        np.testing.assert_allclose(mimetra.Sequence.load(path).positions, self.arrays.positions,
                                   atol=1e-5)

    def test_a_folder_is_replaced_only_where_all_in_it_was_saved(self):
        folder = self.path / "frames"
        self.arrays.save(folder)
        self.arrays.save(folder, force=True, format="obj")
        self.assertTrue((folder / "frame_0000.obj").exists())
        notes = folder / "notes.txt"
        notes.write_text("mine")
        with self.assertRaisesRegex(mimetra.OutputError, "holds 'notes.txt'"):
            self.arrays.save(folder, force=True)
        self.assertEqual(notes.read_text(), "mine")
        self.assertTrue((folder / "frame_0000.obj").exists())


if __name__ == "__main__":
    unittest.main()
