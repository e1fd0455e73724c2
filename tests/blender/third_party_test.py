"""Third-party operations are in the panel, and run on the active object."""

import types

import bpy
import numpy as np
from host import HostTest, command, run_tests
from mimetra_blender import mimetra, properties, settings


class Layout:
    """What a panel draws into; knows what was drawn."""

    def __init__(self):
        self.drawn = []

    def row(self, **_):
        return self

    column = row

    def label(self, **_):
        pass

    def prop(self, group, name, **_):
        self.drawn.append(group.bl_rna.properties[name].identifier)

    def operator(self, name):
        self.drawn.append(name)
        return types.SimpleNamespace()


def drawn(name):
    """What the panel of an operation, or what is below it, holds."""
    panel = getattr(bpy.types, f"MIMETRA_PT_{name}")
    layout = Layout()
    panel.draw(types.SimpleNamespace(layout=layout, operation=panel.operation), bpy.context)
    return layout.drawn


class ThirdParty(HostTest):
    def test_their_panels_show_their_parameters(self):
        self.assertEqual(drawn("smooth"), ["strength", "iterations", "mimetra.smooth"])
        self.assertEqual(drawn("speed"), ["mimetra.speed"])

    def test_frames_of_their_own_are_the_scenes_until_they_are_set(self):
        group = settings.of(bpy.context.scene, mimetra.operations["smooth"])
        group.use_frames = True
        run = types.SimpleNamespace()
        settings.copy(group, mimetra.operations["smooth"], run)
        self.assertFalse(hasattr(run, "frame_start") or hasattr(run, "frame_end"))
        group.frame_end = 20
        settings.copy(group, mimetra.operations["smooth"], run)
        self.assertEqual(run.frame_end, 20)

    def test_all_panels_can_be_drawn(self):
        for name in mimetra.operations:
            python_name = mimetra.python_name(name)
            shown = drawn(python_name) + drawn(f"{python_name}_more")
            self.assertIn(f"mimetra.{python_name}", shown)
            for parameter in properties.parameters_of(mimetra.operations[name]):
                self.assertIn(properties.property_name(parameter.name), shown)

    def test_they_have_operators_and_panels(self):
        made = bpy.ops.mimetra.smooth.get_rna_type().properties
        self.assertEqual(made["strength"].description, "share of the way to the neighbours' mean")
        self.assertEqual((made["strength"].hard_min, made["strength"].hard_max), (0, 1))
        self.assertEqual(made["iterations"].default, 1)
        for name in ("smooth", "speed"):
            panel = getattr(bpy.types, f"MIMETRA_PT_{name}")
            self.assertEqual(panel.bl_category, "mimetra")

    def test_a_sequence_becomes_a_copy_with_a_mesh_cache(self):
        out = self.path / "smooth.npy"
        command("smooth", self.take, "--strength", 0.3, "--iterations", 4, "-o", out)
        bpy.ops.mimetra.smooth(strength=0.3, iterations=4)
        made = bpy.data.objects["source smooth"]
        self.assert_moves_like(made, np.load(out))
        self.assertEqual(len(made.data.polygons), len(self.source.data.polygons))
        self.assertEqual(len(self.source.modifiers), 0)

    def test_fields_become_colours_of_the_active_object(self):
        bpy.ops.mimetra.speed()
        attribute = self.source.data.attributes["mimetra speed"]
        values = np.empty(len(attribute.data), np.float32)
        attribute.data.foreach_get("value", values)
        expected = mimetra.run("speed", mimetra.Sequence.load(self.take)).out.speed
        np.testing.assert_allclose(values, expected, rtol=1e-3, atol=1e-3)
        self.assertIn("mimetra speed color", self.source.data.color_attributes)


if __name__ == "__main__":
    run_tests()
