"""What is still in use when the interpreter ends stays usable until then."""

import subprocess
import sys
import textwrap
import unittest

SQUARE = """
    import atexit
    keep = {}
    atexit.register(lambda: print(*keep.values()))
    import numpy as np
    import mimetra
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
"""


class Ending(unittest.TestCase):
    def run_script(self, script):
        script = textwrap.dedent(SQUARE) + textwrap.dedent(script)
        done = subprocess.run([sys.executable, "-c", script],
                              capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_arrays_can_be_read_at_exit(self):
        printed = self.run_script("""
            # Above the size from which freed memory goes back to the system at once.
            poses = np.tile(corners, (100000, 1, 1))
            keep["poses"] = mimetra.Sequence(poses, triangles).positions
        """)
        self.assertTrue(printed.startswith("[[[0. 0. 0.]"), printed)

    def test_a_thread_may_still_be_inside_an_operation(self):
        printed = self.run_script("""
            import threading
            begun = threading.Event()
            poses = np.random.default_rng(1).normal(size=(300, 4, 3)) + corners

            def run():
                while True:
                    mimetra.decompose(mimetra.Sequence(poses, triangles), k=4, tolerance=0,
                                      iterations=100000, progress=lambda _: begun.set())

            threading.Thread(target=run, daemon=True).start()
            begun.wait()
            keep["end"] = "reached"
        """)
        self.assertEqual(printed, "reached\n")

    def test_a_thread_may_wait_in_its_own_progress(self):
        printed = self.run_script("""
            import queue
            import threading
            shares = queue.Queue(maxsize=1)
            poses = np.random.default_rng(1).normal(size=(300, 4, 3)) + corners
            threading.Thread(daemon=True, target=lambda: mimetra.decompose(
                mimetra.Sequence(poses, triangles), k=4, progress=shares.put)).start()
            shares.get()
            keep["end"] = "reached"
        """)
        self.assertEqual(printed, "reached\n")


if __name__ == "__main__":
    unittest.main()
