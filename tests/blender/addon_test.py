"""The add-on is there, with an operator, settings and a panel for each operation of the table."""

import os
import zipfile

import bpy
from host import HostTest, mimetra, run_tests
from mimetra_blender import classes, properties, settings


class Addon(HostTest):
    def operator(self, operation):
        return getattr(bpy.ops.mimetra, mimetra.python_name(operation.name))

    def test_the_library_is_that_of_the_zip(self):
        self.assertIn("mimetra_blender", mimetra.__file__)
        self.assertLessEqual({"align", "decompose", "regions", "transfer", "evaluate", "sample"},
                             set(mimetra.operations))

    def test_libraries_of_others_come_with_their_licences(self):
        names = zipfile.ZipFile(os.environ["ADDON_ZIP"]).namelist()
        files = [name.rsplit("/", 1)[-1].lower() for name in names]
        others = [name for name in files if ".so" in name and "libmimetra" not in name]
        # libopenmesh1.copyright is that of libOpenMeshCore and libOpenMeshTools.
        licences = [name.rsplit(".", 1)[0].rstrip("0123456789.") for name in files
                    if name.endswith(".copyright")]
        self.assertGreater(len(others), 0)
        for library in others:
            self.assertTrue(any(library.startswith(each) for each in licences), library)

    def test_each_operation_is_an_operator_that_can_be_undone(self):
        for operation in mimetra.operations.values():
            kind = self.operator(operation).get_rna_type()
            self.assertEqual(kind.description, operation.summary)
            options = getattr(bpy.types, f"MIMETRA_OT_{operation.name}").bl_options
            self.assertEqual(options, {"REGISTER", "UNDO"})

    def test_parameters_are_properties_with_the_tables_ranges_defaults_and_help(self):
        for operation in mimetra.operations.values():
            made = self.operator(operation).get_rna_type().properties
            for parameter in properties.parameters_of(operation):
                with self.subTest(f"{operation.name} {parameter.name}"):
                    one = made[properties.property_name(parameter.name)]
                    self.assertEqual(one.description, parameter.help)
                    is_number = one.type in ("INT", "FLOAT")
                    if is_number and parameter.minimum is not None:
                        self.assertAlmostEqual(one.hard_min, parameter.minimum, 6)
                    if is_number and parameter.maximum is not None:
                        self.assertAlmostEqual(one.hard_max, parameter.maximum, 6)
                    if parameter.kind == "choice":
                        self.assertEqual([item.identifier for item in one.enum_items],
                                         parameter.choices)
                    if parameter.kind in ("number", "integer") and parameter.default is not None:
                        self.assertAlmostEqual(one.default, parameter.default, 6)

    def test_units_stand_in_the_names(self):
        made = bpy.ops.mimetra.transfer.get_rna_type().properties
        units = {each.name: each.unit for each in mimetra.operations["transfer"].parameters}
        for name, unit in units.items():
            if unit and properties.property_name(name) in made:
                self.assertIn(f"[{unit}]", made[properties.property_name(name)].name)

    def test_parameters_of_files_are_left_out(self):
        made = bpy.ops.mimetra.transfer.get_rna_type().properties
        for name in ("fps", "topology", "frames", "format"):
            self.assertNotIn(name, made)
        self.assertNotIn("paraview", bpy.ops.mimetra.regions.get_rna_type().properties)

    def test_parameters_of_files_are_there_where_files_are_read(self):
        made = bpy.ops.mimetra.fit.get_rna_type().properties
        for name in ("frames", "fps", "images", "face_model", "min_confidence"):
            self.assertIn(name, made)
        for name in ("format", "double", "single"):
            self.assertNotIn(name, made)

    def test_a_model_for_landmarks_is_read(self):
        fit, transfer = mimetra.operations["fit"], mimetra.operations["transfer"]
        self.assertIsNone(properties.active_input(fit))
        self.assertEqual([port.name for port in properties.object_inputs(transfer)],
                         ["source", "target"])
        made = bpy.ops.mimetra.fit.get_rna_type().properties
        self.assertEqual(made["model"].subtype, "FILE_PATH")

    def test_the_sidebar_has_a_panel_for_each_operation(self):
        for operation in mimetra.operations.values():
            one = getattr(bpy.types, f"MIMETRA_PT_{operation.name}")
            self.assertEqual((one.bl_region_type, one.bl_category), ("UI", "mimetra"))
        self.assertEqual(bpy.types.MIMETRA_PT_transfer.bl_order, 0)

    def test_the_panel_hands_on_what_was_set_and_nothing_else(self):
        class Operator:
            pass

        operation = mimetra.operations["transfer"]
        group = settings.of(bpy.context.scene, operation)
        operator = Operator()
        settings.copy(group, operation, operator)
        self.assertEqual(vars(operator), {})
        group.k = 12
        group.target = self.target
        group.coverage = 0.5  # its switch is off
        settings.copy(group, operation, operator)
        self.assertEqual(vars(operator), {"k": 12, "target": "target"})
        group.use_coverage = True
        settings.copy(group, operation, operator)
        self.assertEqual(operator.coverage, 0.5)

    def test_operators_wait_for_a_mesh(self):
        self.assertTrue(bpy.ops.mimetra.transfer.poll())
        self.source.select_set(True)
        bpy.ops.object.mode_set(mode="EDIT")
        self.assertFalse(bpy.ops.mimetra.transfer.poll())
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.context.view_layer.objects.active = None
        self.assertFalse(bpy.ops.mimetra.transfer.poll())
        self.assertTrue(bpy.ops.mimetra.sample.poll())

    def test_it_can_be_switched_off_and_on(self):
        bpy.ops.preferences.addon_disable(module="mimetra_blender")
        self.assertFalse(hasattr(bpy.types, "MIMETRA_PT_transfer"))
        self.assertEqual(classes.count(), 0)
        bpy.ops.preferences.addon_enable(module="mimetra_blender")
        self.assertTrue(hasattr(bpy.types, "MIMETRA_PT_transfer"))


if __name__ == "__main__":
    run_tests()
