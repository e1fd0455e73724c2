"""The Python example of the README runs and prints what it says."""

import contextlib
import io
import pathlib
import re
import unittest


class Readme(unittest.TestCase):
    def test_its_example_runs(self):
        text = (pathlib.Path(__file__).parents[2] / "README.md").read_text()
        (example,) = [code for code in re.findall(r"```python\n(.*?)```", text, re.S)
                      if "import mimetra" in code]
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(example, "README.md", "exec"), {})
        self.assertRegex(printed.getvalue(), r"\(120, 5126, 3\) 0\.\d+")


if __name__ == "__main__":
    unittest.main()
