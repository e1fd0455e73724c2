"""MeshLab knows the plugin's filters, with the parameters of the operations table."""

import re
import unittest

from host import *


class Loading(HostTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        dump = cls.path / "filters.txt"
        cls.meshlab.run("-d", dump)
        cls.sections = {}
        for section in re.split(r"\\section f\d+ ", dump.read_text())[1:]:
            name, text = section.split("\n", 1)
            cls.sections[name.strip()] = text

    def test_lists_its_filters_with_what_they_do(self):
        for name, words in [("Geodesic Support Map", "selected vertices"),
                            ("Regions of Interest", "visible layers"),
                            ("Region Transfer", "hidden layer"),
                            ("mimetra Align", "new, hidden layer"),
                            ("mimetra Evaluate", "The target is the current layer"),
                            ("mimetra Info", "visible layers")]:
            self.assertIn(words, self.sections[name])

    def test_has_a_filter_for_every_operation_that_begins_with_a_mesh(self):
        of_mimetra = {*OPERATIONS.values()}
        of_mimetra |= {operation_of(name)["name"] for name in self.sections
                       if name.startswith("mimetra ")}
        first = {name: next((each for each in operation.get("inputs", []) if not each["optional"]),
                            {"kind": None}) for name, operation in operations().items()}
        # MeshLab draws what it shows itself; markers are a file that people edit; its layers have
        # no expressions.
        left_out = {"render", "markers", "rig"}
        self.assertEqual(of_mimetra | left_out, {name for name, each in first.items()
                                                 if each["kind"] in ["sequence", "model"]})

    def test_has_a_row_for_every_parameter(self):
        values = {"RichBool": "Bool", "RichInt": "Int", "RichFloat": "Float", "RichEnum": "Enum",
                  "RichString": "String"}
        for name in [*OPERATIONS, *OF_LAYERS]:
            found = re.findall(r"<TR><TD> \\c (\w+)\s+</TD> <TD> (.*?) </TD>", self.sections[name])
            expected = []
            for row, kind, _ in rows_of(name):
                label = row.replace("-", " ")
                label = "Further options" if row == "options" else label[0].upper() + label[1:]
                expected.append((values[kind], label))
            self.assertEqual(found, expected)

    def test_lists_everything_else_as_further_options(self):
        for name in ["Regions of Interest", "Region Transfer", *OF_LAYERS]:
            [line] = re.findall(r"Further options </TD> <TD><i> (.*?) -- </i>",
                                self.sections[name])
            operation = operation_of(name)
            expected = [input["name"] for input in operation["inputs"] if input["optional"]]
            expected += [parameter["name"] for parameter in operation["parameters"]
                         if parameter["name"] not in {*OF_FILES} - {*READING}]
            expected += [output["name"] for output in operation.get("outputs", [])
                         if output["optional"] and output["name"] != "paraview"]
            rows = [row[0] for row in rows_of(name)]
            self.assertEqual(line.split(": ")[1].split(),
                             ["--" + option for option in expected if option not in rows])

    def test_says_what_the_table_says_of_each_parameter(self):
        for name, operation in OPERATIONS.items():
            for parameter in operations()[operation]["parameters"]:
                if parameter["name"] in [row[0] for row in rows_of(name)][2:]:
                    self.assertIn(parameter["help"], self.sections[name])


if __name__ == "__main__":
    unittest.main()
