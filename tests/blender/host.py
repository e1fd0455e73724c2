"""What the tests of Blender's add-on share: the add-on, heads as objects, the command's results."""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import bpy
import numpy as np

bpy.ops.preferences.addon_install(filepath=os.environ["ADDON_ZIP"], overwrite=True)
bpy.ops.preferences.addon_enable(module="mimetra_blender")

from mimetra_blender import mimetra, properties, sources  # noqa: E402  (there now)

FRAMES = range(1, 122, 10)
LAST = 120


def command(*arguments):
    """Runs the command; what it prints on standard output."""
    done = subprocess.run([os.environ["MIMETRA"], *map(str, arguments)], check=True,
                          capture_output=True, text=True)
    return done.stdout


def run_tests():
    """All tests of the script; Blender ends with their result."""
    suite = unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"])
    passed = unittest.TextTestRunner(stream=sys.stdout).run(suite).wasSuccessful()
    sys.stdout.flush()
    os._exit(0 if passed else 1)


def column(path, name):
    """A column of a CSV file."""
    with open(path, newline="") as file:
        return np.array([float(row[name]) for row in csv.DictReader(file)])


class HostTest(unittest.TestCase):
    """Each test has a scene with the performance of a head, `source`, and another head, `target`.

    The command has the same: take.npy, and a model folder.
    """

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="mimetra_blender_")
        cls.path = pathlib.Path(cls.folder.name)
        cls.head = cls.path / "head"
        command("sample", "-o", cls.head)
        cls.actor = f"{cls.head}@identity002=1"
        cls.take = cls.path / "take.npy"
        command("convert", f"{cls.head}@identity001=1", "--weights", cls.head / "performance.csv",
                "-o", cls.take)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        bpy.ops.preferences.addon_enable(module="mimetra_blender")
        scene = bpy.context.scene
        scene.frame_start, scene.frame_end = 1, LAST
        scene.render.fps = 30
        scene.frame_set(7)
        weights = {name: column(self.head / "performance.csv", name)
                   for name in mimetra.Model.load(self.actor).expression_names}
        self.source = self.object_of("source", f"{self.head}@identity001=1", weights)
        self.target = self.object_of("target", self.actor)
        self.activate(self.source)

    def object_of(self, name, model, weights=None):
        """A model as an object with shape keys, which move by weights {name: F}."""
        model = mimetra.Model.load(model)
        made = self.mesh_of(name, model["neutral"], model.faces)
        made.shape_key_add(name="Basis", from_mix=False)
        for key_name, shape in zip(model["expression_names"], model["expressions"]):
            key = made.shape_key_add(name=key_name, from_mix=False)
            key.data.foreach_set("co", (model["neutral"] + shape).astype(np.float32).ravel())
            for frame, value in enumerate([] if weights is None else weights[key_name], 1):
                key.value = value
                key.keyframe_insert("value", frame=frame)
        return made

    def mesh_of(self, name, vertices, faces):
        mesh = bpy.data.meshes.new(name)
        ends = np.cumsum(faces.sizes)
        mesh.from_pydata(vertices.tolist(), [],
                         [part.tolist() for part in np.split(faces.corners, ends[:-1])])
        made = bpy.data.objects.new(name, mesh)
        bpy.context.collection.objects.link(made)
        return made

    def bare_target(self):
        """The target without shape keys."""
        model = mimetra.Model.load(self.actor)
        return self.mesh_of("bare", model["neutral"], model.faces)

    def activate(self, subject):
        bpy.ops.object.select_all(action="DESELECT")
        subject.select_set(True)
        bpy.context.view_layer.objects.active = subject

    def shown(self, subject, frame):
        """An object's vertices at a frame, as Blender shows them."""
        bpy.context.scene.frame_set(frame)
        evaluated = subject.evaluated_get(bpy.context.evaluated_depsgraph_get())
        mesh = evaluated.to_mesh()
        positions = sources.coordinates(mesh.vertices)
        evaluated.to_mesh_clear()
        return positions

    def keyed(self, subject):
        """Keyed values of an object's shape keys over the scene's frames, {name: F}."""
        made = {}
        for curve in subject.data.shape_keys.animation_data.action.fcurves:
            name = curve.data_path.split('"')[1]
            made[name] = np.array([curve.evaluate(frame) for frame in range(1, LAST + 1)])
        return made

    def assert_close(self, found, expected, what=""):
        """Equal to the single precision in which Blender holds positions."""
        extent = np.ptp(np.asarray(expected).reshape(-1, np.shape(expected)[-1]), axis=0).max()
        self.assertEqual(found.shape, expected.shape, what)
        self.assertLess(np.abs(found - expected).max(), 1e-5 * max(extent, 1), what)

    def assert_moves_like(self, subject, positions, frames=FRAMES[:-1]):
        """Shown at frames as the poses of the whole performance are."""
        for frame in frames:
            self.assert_close(self.shown(subject, frame), positions[frame - 1], f"frame {frame}")

    def assert_fails(self, text, call, **options):
        """The operator reports an error."""
        with self.assertRaisesRegex(RuntimeError, text):
            call(**options)
