"""Signatures, docstrings and type hints are those of the operations table."""

import ast
import inspect
import json
import pathlib
import unittest

import mimetra
from mimetra import stub
from sample import command


class Hints(unittest.TestCase):
    def test_each_operation_of_the_table_is_a_function(self):
        for name, operation in mimetra.operations.items():
            with self.subTest(name):
                function = getattr(mimetra, mimetra.function_name(name))
                self.assertIs(function.operation, operation)
                slots = inspect.signature(function).parameters
                self.assertEqual(set(slots), set(function.__annotations__))
                for port in operation.inputs:
                    self.assertIn(port.help, function.__doc__)
                for parameter in operation.parameters:
                    slot = slots[mimetra.python_name(parameter.name)]
                    self.assertEqual(slot.default, parameter.default)
                    self.assertIn(f"{slot.name}: {parameter.help}", function.__doc__)

    def test_parameters_are_those_that_the_command_tells(self):
        told = {each["name"]: each for each in json.loads(command("operations", "--json"))
                ["operations"]}
        for name, operation in mimetra.operations.items():
            listed = {each["name"]: each for each in told[name].get("parameters", [])}
            with self.subTest(name):
                self.assertLessEqual({each.name for each in operation.parameters}, set(listed))
                for parameter in operation.parameters:
                    expected = listed[parameter.name]
                    self.assertEqual(parameter.help, expected["help"])
                    self.assertEqual(parameter.minimum, expected.get("minimum"))
                    self.assertEqual(parameter.maximum, expected.get("maximum"))
                    self.assertEqual(parameter.unit, expected.get("unit", ""))
                    self.assertEqual(parameter.choices, expected.get("choices", []))

    def test_parameters_of_files_are_those_of_reading(self):
        """What load() takes for inputs of an operation's kinds; what save() takes is left out."""
        for name, operation in mimetra.operations.items():
            known = set()
            for port in operation.inputs:
                if port.kind is mimetra.Regions:
                    continue
                with self.assertRaises(mimetra.Error) as caught:
                    port.kind.load("nothing", no_setting=1)
                known |= set(str(caught.exception).split("with one of ")[-1].split(", "))
            for parameter in operation.parameters:
                if parameter.of_files:
                    self.assertIn(parameter.name, known, name)

    def test_docstrings_tell_ranges_units_and_choices(self):
        self.assertIn("k: number of components; at least 1", mimetra.regions.__doc__)
        self.assertIn("[frames per second]", mimetra.regions.__doc__)
        self.assertIn("one of 'disc', 'support'", mimetra.regions.__doc__)
        self.assertIn("0 to 1", mimetra.regions.__doc__)

    def test_the_stub_declares_what_the_module_has(self):
        path = pathlib.Path(mimetra.__file__).with_suffix(".pyi")
        self.assertEqual(path.read_text(), stub.text())
        self.assertTrue(path.with_name("py.typed").exists())
        declared = {}
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                declared[node.name] = node
        for name in mimetra.__all__:
            if name not in ("operations", "formats"):
                self.assertIn(name, declared)
        slots = [slot.arg for slot in declared["transfer"].args.kwonlyargs]
        self.assertEqual(slots, list(inspect.signature(mimetra.transfer).parameters)[2:])


if __name__ == "__main__":
    unittest.main()
