"""Third-party operations are in the panel, and run on the active object."""

import bpy
import numpy as np
from host import HostTest, command, run_tests
from mimetra_blender import mimetra


class ThirdParty(HostTest):
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
