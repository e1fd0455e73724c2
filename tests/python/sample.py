"""What the tests of the Python module share: the built-in sample, and the command's results."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import mimetra

FRAMES = "0:120:10"


def command(*arguments):
    """Runs the command; what it prints on standard output."""
    done = subprocess.run([os.environ["MIMETRA"], *map(str, arguments)], check=True,
                          capture_output=True, text=True)
    return done.stdout


class SampleTest(unittest.TestCase):
    """Tests in a folder with a performance of the built-in head, `take`, and its model."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="mimetra_python_")
        cls.path = pathlib.Path(cls.folder.name)
        cls.head = cls.path / "head"
        command("sample", "-o", cls.head)
        cls.actor = f"{cls.head}@identity002=1"
        cls.take = cls.path / "take.npy"
        command("convert", f"{cls.head}@identity001=1", "--weights", cls.head / "performance.csv",
                "--frames", FRAMES, "-o", cls.take)
        loaded = mimetra.Sequence.load(cls.take)
        cls.arrays = mimetra.Sequence(loaded.positions, loaded.faces, loaded.times, loaded.rest)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def assert_same(self, found, expected, what=""):
        """Equal bit for bit, and of one type."""
        self.assertEqual(found.dtype, expected.dtype, what)
        self.assertEqual(found.shape, expected.shape, what)
        self.assertEqual(found.tobytes(), expected.tobytes(), what)
