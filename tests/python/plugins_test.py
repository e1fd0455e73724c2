"""Operations of plugins whose names are words of Python or of the module's own."""

import inspect
import unittest

import mimetra
from mimetra import stub


class Plugins(unittest.TestCase):
    def test_parameters_may_have_any_name(self):
        report = mimetra.run("echo", name="a", operation="b", class_="c").report
        self.assertEqual(report, {"name": "a", "operation": "b", "class": "c"})

    def test_outputs_do_not_hide_the_report(self):
        result = mimetra.echo(frames="all", summary_=True)
        self.assertEqual(result.report, {"frames": "all"})
        self.assertEqual(list(result.report_), ['one, "two"'])
        self.assertEqual(result.summary_['one, "two"'].tolist(), [1.0])

    def test_inputs_and_outputs_may_be_of_every_kind(self):
        (script,) = mimetra.operations["echo"].inputs
        self.assertIs(script.kind, mimetra.Document)
        self.assertIn("page", inspect.signature(mimetra.echo).parameters)
        self.assertIn("def echo(*, script: Document | str", stub.text())


if __name__ == "__main__":
    unittest.main()
