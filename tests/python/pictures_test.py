"""Pictures, pages and ParaView's files, of the library that draws: the bytes of the command."""

import os
import pathlib
import re
import struct
import subprocess
import sys
import unittest
import zlib

import mimetra
import numpy as np
from sample import SampleTest, command


def pixels_of(png):
    """The pixels of a PNG of 8 bits RGB whose rows have no filter."""
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    chunks, at = {}, 8
    while at < len(png):
        size, name = struct.unpack(">I4s", png[at:at + 8])
        content = png[at + 8:at + 8 + size]
        assert struct.unpack(">I", png[at + 8 + size:at + 12 + size])[0] == zlib.crc32(name + content)
        chunks[name] = content
        at += 12 + size
    width, height, depth, colors = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    assert (depth, colors) == (8, 2)
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, -1)
    assert not rows[:, 0].any()
    return rows[:, 1:].reshape(height, width, 3)


class Pictures(SampleTest):
    def test_are_those_of_the_command(self):
        by_command, written = self.path / "command.png", self.path / "python.png"
        command("render", self.take, self.take, "--color", "none,displacement", "--columns", 3,
                "--titles", "pose,distance", "-o", by_command)
        result = mimetra.render([self.arrays, self.arrays], color="none,displacement", columns=3,
                                titles="pose,distance", out=written)
        self.assertEqual(written.read_bytes(), by_command.read_bytes())
        self.assertEqual((result.report["rows"], result.report["columns"]), (2, 3))

    def test_show_themselves_in_notebooks(self):
        picture = mimetra.render([self.arrays], columns=2, size=64).out
        self.assertEqual(picture.pixels.shape[2], 3)
        self.assertGreater(np.ptp(picture.pixels), 100)
        np.testing.assert_array_equal(pixels_of(picture._repr_png_()), picture.pixels)

    def test_show_regions_that_python_found(self):
        found = self.path / "found.pvd"
        view = self.path / "view.py"
        mimetra.regions(self.arrays, k=6, out=found, paraview=view)
        self.assertIn("found.pvd", view.read_text())
        shown = mimetra.Sequence.load(found)
        numbered = mimetra.Sequence(shown.positions, shown.faces, shown.times, shown.rest,
                                    on_vertices={"region": shown.region})
        by_file = mimetra.render([os.fspath(found)], color="region", columns=1).out
        by_value = mimetra.render([numbered], color="region", columns=1).out
        np.testing.assert_array_equal(by_value.pixels, by_file.pixels)


def played(page):
    """What the 3D player of a page shows: all else tells times that runs took."""
    return re.search(r'id="performance">(.*?)</script>', page, re.DOTALL).group(1)


class Pages(SampleTest):
    def test_are_those_of_the_command(self):
        run, by_command = self.path / "run", self.path / "command.html"
        command("transfer", self.take, self.actor, "-k", 6, "-o", run)
        command("report", run, "-o", by_command)
        result = mimetra.report(run, out=self.path / "python.html")
        page, expected = (self.path / "python.html").read_text(), by_command.read_text()
        self.assertEqual(page.count("<img"), expected.count("<img"))
        self.assertEqual(result.report["frames"], 12)
        if result.report["viewer_frames"] == 0:
            self.skipTest("this mimetra was built without npm: its pages have no player")
        self.assertEqual(played(page), played(expected))
        self.assertEqual(played(mimetra.report(run).out.text[0]), played(expected))


class WithoutPictures(unittest.TestCase):
    def test_says_what_is_missing(self):
        library = next(pathlib.Path(mimetra.__file__).parents[3].glob("**/libmimetra_c.so.1"))
        code = "import mimetra; print(len(mimetra.operations)); mimetra.render([])"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              env={**os.environ, "MIMETRA_LIBRARY": str(library)})
        self.assertGreater(int(done.stdout), 10)
        self.assertEqual(done.returncode, 1)
        self.assertIn("libmimetra_pictures.so", done.stderr)


if __name__ == "__main__":
    unittest.main()
