"""Progress, cancelling, logging, and several threads at once."""

import os
import signal
import sys
import threading
import time
import unittest

import mimetra
import numpy as np
from sample import SampleTest


class Watching(SampleTest):
    def test_progress_rises_from_nothing_to_all(self):
        shares = []
        mimetra.transfer(self.arrays, self.actor, k=8, progress=shares.append)
        self.assertGreater(len(shares), 5)
        self.assertEqual(shares, sorted(shares))
        self.assertGreaterEqual(shares[0], 0)
        self.assertEqual(shares[-1], 1)

    def test_threads_may_look_at_one_value(self):
        failed = []

        def look(value):
            try:
                value.location("field 59")
            except KeyError as error:
                failed.append(error)

        interval = sys.getswitchinterval()
        sys.setswitchinterval(1e-6)
        try:
            for _ in range(100):
                fields = mimetra.Sequence(
                    [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]],
                    on_vertices={f"field {index}": [0, 0, 0] for index in range(60)})
                threads = [threading.Thread(target=look, args=(fields,)) for _ in range(4)]
                for thread in threads:
                    thread.start()
                for thread in threads:
                    thread.join()
        finally:
            sys.setswitchinterval(interval)
        self.assertEqual(failed, [])

    def test_false_as_the_answer_cancels(self):
        shares = []

        def watch(share):
            shares.append(share)
            return share < 0.3

        with self.assertRaises(mimetra.Cancelled) as caught:
            mimetra.regions(self.arrays, k=20, progress=watch)
        self.assertEqual(caught.exception.status, 130)
        self.assertLess(shares[-1], 0.9)
        self.assertEqual(len(mimetra.regions(self.arrays, k=2).out.masks), 2)

    def test_a_false_of_numpy_cancels_too(self):
        limit = np.array([0.3])
        with self.assertRaises(mimetra.Cancelled):
            mimetra.regions(self.arrays, k=20, progress=lambda share: share < limit[0])

    def test_what_progress_raises_comes_out(self):
        def watch(_):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            mimetra.regions(self.arrays, k=5, progress=watch)

    def test_control_c_ends_a_run(self):
        def press(share):
            if share > 0.2:
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            mimetra.regions(self.arrays, k=20, progress=press)
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)

    def test_control_c_ends_a_run_without_progress(self):
        # A run that would take minutes.
        poses = np.random.default_rng(1).normal(size=(60, 5126, 3))
        take = mimetra.Sequence(poses, self.arrays.faces)
        pressed = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        begun = time.monotonic()
        pressed.start()
        with self.assertRaises(KeyboardInterrupt):
            mimetra.decompose(take, k=40, tolerance=0, iterations=10000)
        self.assertLess(time.monotonic() - begun, 30)

    def test_what_the_library_tells_is_logged(self):
        bare = mimetra.Sequence(self.arrays.positions, self.arrays.faces)
        with self.assertLogs("mimetra", "WARNING") as logs:
            mimetra.transfer(bare, self.actor, k=4)
        self.assertIn("first frame", " ".join(logs.output))

    def test_two_threads_run_two_operations_at_once(self):
        alone = [mimetra.transfer(self.arrays, self.actor, k=k).out.positions.copy()
                 for k in (6, 12)]
        both = threading.Barrier(2)
        found, failed = {}, []

        def run(index, k):
            both.wait()
            for _ in range(3):
                found[index] = mimetra.transfer(self.arrays, self.actor, k=k).out.positions
                try:
                    mimetra.regions(self.arrays, k=-index)
                except mimetra.UsageError as error:
                    failed.append((index, str(error)))

        threads = [threading.Thread(target=run, args=each) for each in [(0, 6), (1, 12)]]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for index, expected in enumerate(alone):
            self.assert_same(found[index], expected)
        self.assertEqual(len(failed), 6)
        for index, text in failed:
            self.assertIn(f"found '{-index}'", text)


if __name__ == "__main__":
    unittest.main()
