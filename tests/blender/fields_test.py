"""Regions, fields, components, tables and models as Blender shows them."""

import json
import pathlib
import re

import bpy
import numpy as np
from host import HostTest, command, run_tests
from mimetra_blender import keying, mimetra, results


class Fields(HostTest):
    def values(self, name, dtype=np.int32):
        attribute = self.source.data.attributes[name]
        values = np.empty(len(attribute.data), dtype)
        attribute.data.foreach_get("value", values)
        return values

    def regions(self):
        out = self.path / "regions.json"
        command("regions", self.take, "-k", 8, "-o", out, "--force")
        return json.loads(out.read_text())["regions"]

    def test_regions_are_vertex_groups(self):
        bpy.ops.mimetra.regions(k=8)
        groups = {index: set() for index in range(len(self.source.vertex_groups))}
        for vertex in self.source.data.vertices:
            for group in vertex.groups:
                groups[group.group].add(vertex.index)
        for index, region in enumerate(self.regions()):
            self.assertEqual(groups[index], set(region["vertices"]))

    def test_regions_of_an_earlier_run_go(self):
        bpy.ops.mimetra.regions(k=8)
        self.source.vertex_groups.new(name="mine")
        self.source.vertex_groups.new(name="mimetra regions of mine")
        bpy.ops.mimetra.regions(k=3)
        self.assertEqual({group.name for group in self.source.vertex_groups},
                         {"mine", "mimetra regions of mine",
                          *(f"mimetra region {index:02}" for index in range(3))})

    def test_fields_are_attributes_and_colours(self):
        bpy.ops.mimetra.regions(k=8)
        region, roi = self.values("mimetra region"), self.values("mimetra roi")
        np.testing.assert_array_equal(region >= 0, roi == 1)
        inside = {vertex for each in self.regions() for vertex in each["vertices"]}
        self.assertEqual(set(np.flatnonzero(roi).tolist()), inside)
        colors = self.source.data.color_attributes
        self.assertEqual(colors.active_color.name, "mimetra region color")
        # Each face in one colour, that of the region of most of its corners, as pictures draw it.
        mesh = self.source.data
        shown = np.empty(4 * len(mesh.loops), np.float32)
        colors["mimetra region color"].data.foreach_get("color", shown)
        shown = shown.reshape(-1, 4)
        table = mimetra.regions(mimetra.Sequence.load(self.take), k=8).out.colors / 255
        for face in mesh.polygons:
            regions = [int(region[vertex]) for vertex in face.vertices]
            most = max(sorted(set(regions)), key=regions.count)
            srgb = table[most] if most >= 0 else np.array([205, 190, 178]) / 255
            linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
            for loop in face.loop_indices:
                np.testing.assert_allclose(shown[loop, :3], linear, atol=1e-3)
        on_faces = self.values("mimetra in_L")
        self.assertEqual(len(on_faces), len(self.source.data.polygons))
        faces = [any(vertex in inside for vertex in face.vertices)
                 for face in self.source.data.polygons]
        self.assertTrue(set(np.flatnonzero(on_faces)) <= set(np.flatnonzero(faces)))

    def test_distances_are_shown_at_the_first_frame(self):
        bpy.ops.mimetra.geodesic(source="100", geodesics="exact", frame_start=1, frame_end=1)
        distance = self.values("mimetra distance", np.float32)
        take = mimetra.Sequence.load(self.take, frames="0:1")
        expected = mimetra.geodesic(take, source=[100], geodesics="exact").out.distance
        finite = np.isfinite(expected)
        np.testing.assert_allclose(distance[finite], expected[finite], rtol=1e-4, atol=1e-3)
        self.assertEqual(distance[100], 0)

    def test_components_are_shape_keys(self):
        bpy.ops.mimetra.decompose(k=4)
        made = bpy.data.objects["source decompose"]
        take = mimetra.Sequence.load(self.take)
        expected = mimetra.decompose(take, k=4).out
        poses = expected.rest + np.tensordot(expected.weights, expected.displacements, 1)
        self.assert_moves_like(made, poses)
        self.assertEqual(len(made.data.shape_keys.key_blocks), 5)

    def test_components_go_into_files_and_come_back(self):
        path = self.path / "components.h5"
        bpy.ops.mimetra.regions(k=4, components_out=str(path))
        groups = len(self.source.vertex_groups)
        self.assertTrue(path.exists())
        self.assertGreater(groups, 0)
        self.source.vertex_groups.clear()
        bpy.ops.mimetra.regions(components=str(path))
        self.assertEqual(len(self.source.vertex_groups), groups)

    def track(self):
        """Landmarks of the first frames of the take, and their images."""
        lines = (self.head / "landmarks68.txt").read_text().splitlines()
        pairs = [tuple(map(int, line.split("="))) for line in lines if line[:1].isdigit()]
        points = np.full((5, 68, 2), np.nan)
        for landmark, vertex in pairs:
            points[:, landmark - 1] = np.load(self.take)[:5, vertex, :2] * [1, -1] + 300
        names = ",".join(f"x{landmark},y{landmark}" for landmark in range(68))
        np.savetxt(self.path / "track.csv", points.reshape(5, -1), delimiter=",", header=names,
                   comments="")
        image = bpy.data.images.new("background", 600, 600)
        image.file_format = "PNG"
        for frame in range(5):
            image.filepath_raw = str(self.path / f"frame{frame}.png")
            image.save()
        return self.path / "track.csv", self.path / "frame*.png"

    def test_a_fit_reads_landmarks_as_the_command_does(self):
        track, images = self.track()
        out = self.path / "fit.npy"
        command("fit", track, "--model", self.head, "--frames", "1:5:2", "-o", out, "--force")
        bpy.ops.mimetra.fit(landmarks=str(track), model=str(self.head), frames="1:5:2",
                            images=str(images), strip=True, overlay=True)
        fitted = np.load(out)
        for index in range(2):
            self.assert_close(self.shown(bpy.data.objects["fit"], 1 + index), fitted[index])
        drawn = mimetra.fit(track, model=self.head, frames="1:5:2", images=images, strip=True,
                            overlay=True)
        self.assertEqual(list(drawn.overlay), ["pixels_0", "pixels_1"])
        for name, expected in [("fit strip", drawn.strip.pixels),
                               ("fit overlay 0000", drawn.overlay.pixels_0),
                               ("fit overlay 0001", drawn.overlay.pixels_1)]:
            image = bpy.data.images[name]
            shown = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)
            self.assertGreater(len(np.unique(expected)), 2, name)
            np.testing.assert_array_equal(np.rint(255 * shown[::-1, :, :3]), expected, name)

    def test_tables_and_summaries_are_text(self):
        bpy.ops.mimetra.evaluate(target="target", k="4,8", out=True)
        text = bpy.data.texts["source evaluate out.csv"].as_string()
        self.assertTrue(text.startswith("k,"))
        self.assertEqual(len(text.strip().splitlines()), 4)
        bpy.ops.mimetra.info()
        self.assertIn("frames      120", bpy.data.texts["mimetra info"].as_string())

    def test_weights_of_another_rig_are_text(self):
        answer = bpy.ops.mimetra.retarget(source="source", target="target",
                                          weights=str(self.head / "performance.csv"))
        self.assertEqual(answer, {"FINISHED"})
        lines = bpy.data.texts["retarget out.csv"].as_string().strip().splitlines()
        self.assertTrue(lines[0].startswith("time,"))
        self.assertEqual(len(lines), 121)

    def test_a_check_is_text(self):
        bpy.ops.mimetra.check()
        self.assertIn("usable, 120 frames of 5126 vertices",
                      bpy.data.texts["mimetra check"].as_string())

    def test_the_sample_is_a_head_that_performs_and_its_identities(self):
        bpy.ops.mimetra.sample()
        head = bpy.data.objects["sample"]
        self.assertEqual(len(head.data.shape_keys.key_blocks), 13)
        weights = self.keyed(head)
        self.assertGreater(weights["jawOpen"].max(), 0.5)
        for index in range(4):
            self.assertIn(f"sample identity00{index}", bpy.data.objects)

    def test_a_performance_keeps_its_times_at_another_rate(self):
        bpy.context.scene.render.fps = 60
        bpy.ops.mimetra.sample()
        (curve, *_) = bpy.data.objects["sample"].data.shape_keys.animation_data.action.fcurves
        frames = [point.co[0] for point in curve.keyframe_points]
        self.assertEqual(frames, list(range(1, 2 * 120, 2)))

    def test_weights_beyond_what_blender_keeps_are_told_of(self):
        frames = results.Frames(bpy.context.scene, [1, 2], "PC2", "//")
        keying.set_keys(self.target, {"jawOpen": np.array([0, 10.0])}, frames)
        self.assertEqual(frames.notes, [])
        keying.set_keys(self.target, {"jawOpen": np.array([0, -12.0])}, frames)
        self.assertIn("'jawOpen' reaches 12;", frames.notes[0])

    def test_a_mesh_cache_keeps_its_times(self):
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
        poses = np.stack([corners, corners + [0, 0, 1], corners + [0, 0, 2]])
        for cache_format in ("PC2", "MDD"):
            frames = results.Frames(bpy.context.scene, [11, 12], cache_format, str(self.path))
            value = mimetra.Sequence(poses, [[0, 1, 2]], times=[0, 0.5, 1])
            made = results.show_sequence(bpy.context, value, None, frames, "slow")
            for frame, height in ((11, 0), (26, 1), (41, 2)):
                np.testing.assert_allclose(self.shown(made, frame)[:, 2], height, atol=1e-5)
            bpy.data.objects.remove(made)

    def test_fields_of_a_sequence_are_on_its_object(self):
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
        poses = np.stack([corners, 2 * corners])
        value = mimetra.Sequence(poses, [[0, 1, 2]], on_vertices={"height": [3.0, 4.0, 5.0]})
        frames = results.Frames(bpy.context.scene, [1, 2], "PC2", str(self.path))
        made = results.show_sequence(bpy.context, value, None, frames, "shown")
        heights = [each.value for each in made.data.attributes["mimetra height"].data]
        self.assertEqual(heights, [3, 4, 5])

    def test_a_model_without_a_performance_is_an_object_with_shape_keys(self):
        value = mimetra.Model.load(f"{self.head}@identity002=1")
        frames = results.Frames(bpy.context.scene, [1], "PC2", "//")
        made = results.show_model(bpy.context, value, frames, "still")
        self.assertEqual(len(made.data.shape_keys.key_blocks), 13)
        self.assertIsNone(made.data.shape_keys.animation_data)
        mesh = results.show_model(bpy.context, mimetra.Model(value.neutral, value.faces), frames,
                                  "mesh")
        self.assert_close(self.shown(mesh, 1), value.neutral.astype(np.float32))

    def test_the_example_of_the_documents_runs(self):
        text = (pathlib.Path(__file__).parents[2] / "docs" / "blender.md").read_text()
        (example,) = re.findall(r"```python\n(.*?)```", text, re.S)
        exec(compile(example, "blender.md", "exec"), {})
        weights = self.keyed(bpy.data.objects["sample identity002"])
        self.assertGreater(weights["jawOpen"].max(), 0.5)


if __name__ == "__main__":
    run_tests()
