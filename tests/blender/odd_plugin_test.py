"""Third-party operations whose names and values are unusual: Blender takes all that it can."""

import bpy
import numpy as np
from host import HostTest, mimetra, run_tests
from mimetra_blender import properties, settings


class OddPlugin(HostTest):
    def colors(self, name):
        shown = np.empty(4 * len(self.source.data.vertices), np.float32)
        self.source.data.color_attributes[name].data.foreach_get("color", shown)
        return shown.reshape(-1, 4)

    def assert_unchanged(self):
        self.assertEqual([name for name in self.source.data.attributes.keys() if "mimetra" in name],
                         [])
        self.assertEqual({each.name for each in bpy.data.objects}, {"source", "target"})

    def test_a_name_too_long_for_blender_leaves_the_others(self):
        name = next(name for name in mimetra.operations if name.startswith("a-name-that"))
        taken = dir(bpy.ops.mimetra)
        self.assertNotIn(mimetra.python_name(name), taken)
        self.assertFalse(hasattr(bpy.context.scene.mimetra, mimetra.python_name(name)))
        self.assertLessEqual({"echo", "labels", "transfer"}, set(taken))

    def test_parameters_may_be_called_as_what_operators_have(self):
        operation = mimetra.operations["echo"]
        options = {properties.property_name(parameter.name): parameter.name
                   for parameter in operation.parameters}
        self.assertEqual(bpy.ops.mimetra.echo(**options), {"FINISHED"})
        shown = bpy.data.texts["mimetra echo"].as_string()
        for parameter in operation.parameters:
            self.assertIn(f'"{parameter.name}": "{parameter.name}"', shown)
        group = settings.of(bpy.context.scene, operation)
        group.operation = "set"
        self.assertEqual(group.operation, "set")

    def test_names_of_columns_may_have_commas(self):
        bpy.ops.mimetra.echo()
        self.assertEqual(bpy.data.texts["echo report.csv"].as_string(), '"one, ""two"""\n1.0\n')

    def test_integers_may_be_large(self):
        bpy.ops.mimetra.labels()
        shown = self.colors("mimetra label color")
        self.assertEqual(len(np.unique(shown, axis=0)), 3)
        np.testing.assert_array_equal(shown[1], shown[-2])

    def test_fields_of_another_mesh_are_refused(self):
        self.assert_fails("source: 5126 vertices, expected 3 as in out",
                          bpy.ops.mimetra.other_vertices)
        self.assert_unchanged()
        self.assert_fails("source: [0-9]+ faces, expected the [0-9]+ of out",
                          bpy.ops.mimetra.other_faces)
        self.assert_unchanged()

    def test_regions_need_no_mesh_of_their_own(self):
        bpy.ops.mimetra.most()
        (group,) = self.source.vertex_groups
        inside = [vertex.index for vertex in self.source.data.vertices if vertex.groups]
        self.assertEqual(group.name, "mimetra region 00")
        self.assertEqual(inside, list(range(1, 5126)))

    def test_a_result_that_only_a_file_holds_needs_its_path_before_the_run(self):
        self.assert_fails("landmarks: expected a path for out", bpy.ops.mimetra.landmarks)
        self.assert_fails(r"nowhere\.pts.*\.csv", bpy.ops.mimetra.landmarks, out="/nowhere.pts")


if __name__ == "__main__":
    run_tests()
