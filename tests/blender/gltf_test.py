"""GLB files of the command, opened by Blender's own importer."""

import csv
import json
import os
import pathlib
import unittest

import bpy
import numpy as np
from host import HostTest, command, run_tests

# Debian's Blender asks its NumPy for a name that this one no longer has.
np.bool = getattr(np, "bool", bool)

SHARED = pathlib.Path(__file__).resolve().parents[3] / "shared" / "data"
FACECAP = pathlib.Path(os.environ.get("MIMETRA_DATA", SHARED)) / "facecap"


def rows(path):
    """Names, times and weights (F x D) of a CSV file of weights."""
    with open(path, newline="") as file:
        names, *values = csv.reader(file)
    values = np.array(values, dtype=float)
    return names[1:], values[:, 0], values[:, 1:]


def y_up(points):
    """As glTF has them: Blender's z is up."""
    return np.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=1)


class Gltf(HostTest):
    def imported(self, path):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        bpy.ops.import_scene.gltf(filepath=str(path), merge_vertices=False)
        (face,) = [thing for thing in bpy.context.scene.objects if thing.type == "MESH"]
        return face

    def assert_shows(self, face, names, times, weights):
        """The shape keys of `face` have these names, and at these times these values."""
        keys = face.data.shape_keys
        self.assertEqual([key.name for key in keys.key_blocks][1:], list(names))
        scene = bpy.context.scene
        fps = scene.render.fps / scene.render.fps_base
        for f in (0, 1, len(times) // 3, len(times) - 1):
            frame = times[f] * fps
            scene.frame_set(int(frame), subframe=frame - int(frame))
            shown = [key.value for key in keys.key_blocks][1:]
            np.testing.assert_allclose(shown, weights[f], atol=1e-4)

    def assert_posed(self, face, positions):
        """At the frame that is set, the vertices of `face` are there (N x 3)."""
        mesh = face.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", points)
        extent = np.ptp(positions, axis=0).max()
        np.testing.assert_allclose(y_up(points.reshape(-1, 3)), positions, atol=1e-4 * extent)

    def test_a_performance_is_shape_keys_over_time(self):
        glb = self.path / "take.glb"
        weights = self.head / "performance.csv"
        command("convert", self.head, "--weights", weights, "-o", glb)
        names, times, values = rows(weights)
        face = self.imported(glb)
        drawn = [key.name for key in face.data.shape_keys.key_blocks][1:]
        self.assert_shows(face, drawn, times, values[:, [names.index(name) for name in drawn]])
        command("convert", glb, "-o", self.path / "poses.npy")
        self.assert_posed(face, np.load(self.path / "poses.npy")[-1])

    def test_poses_without_a_model_are_a_shape_key_each(self):
        glb = self.path / "poses.glb"
        command("convert", self.take, "--frames", "0:20", "-o", glb)
        face = self.imported(glb)
        names = [f"frame_{f:04}" for f in range(20)]
        self.assert_shows(face, names, np.arange(20) / 30, np.eye(20))
        self.assert_posed(face, np.load(self.take)[19])

    @unittest.skipUnless(FACECAP.is_dir(), "needs the capture of shared data")
    def test_a_capture_that_was_compressed_has_its_shape_keys_over_time(self):
        glb = self.path / "capture.glb"
        command("convert", FACECAP / "facecap.glb", "-o", glb)
        face = self.imported(glb)
        names, _, weights = rows(FACECAP / "weights.csv")
        command("convert", glb, "-o", self.path / "capture.npz")
        # The CSV's times have four decimals.
        self.assert_shows(face, names, np.load(self.path / "capture.npz")["times"], weights)
        self.assertEqual(json.loads(command("info", glb, "--json"))["vertices"],
                         len(face.data.vertices))


run_tests()
