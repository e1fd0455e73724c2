"""Filters show their progress, and stop where the user aborts."""

import unittest

from host import *

WHILE_READING, WHILE_COMPUTING = 0.1, 0.6


class Progress(HostTest):
    def filter(self):
        source = simple.mimetraSequence(FileName=str(self.sample.take))
        return simple.RegionsofInterest(Input=source, K=12)

    def test_is_shown_while_time_steps_are_read_and_components_are_computed(self):
        filter = self.filter()
        algorithm = filter.GetClientSideObject()
        shares = []
        algorithm.AddObserver("ProgressEvent", lambda *_: shares.append(algorithm.GetProgress()))
        at(filter, 0)
        self.assertEqual(shares, sorted(shares))
        self.assertEqual((shares[0], shares[-1]), (0, 1))
        self.assertGreater(sum(share < 0.3 for share in shares), 10)
        self.assertGreater(sum(0.3 < share < 1 for share in shares), 5)

    def aborted(self, share):
        """A filter that was aborted when it was so far."""
        filter = self.filter()
        algorithm = filter.GetClientSideObject()

        def abort(*_):
            if algorithm.GetProgress() >= share:
                algorithm.SetAbortExecute(1)

        observer = algorithm.AddObserver("ProgressEvent", abort)
        with Messages() as messages:
            shown = at(filter, 0)
        algorithm.RemoveObserver(observer)
        self.assertEqual(shown.GetNumberOfPoints(), 0)
        self.assertEqual(messages.text, "")
        self.assertEqual(decompositions(filter), 0)
        return filter

    def test_ends_with_an_abort_while_time_steps_are_read(self):
        self.aborted(WHILE_READING)

    def test_ends_with_an_abort_while_components_are_computed(self):
        self.aborted(WHILE_COMPUTING)

    def test_begins_anew_after_an_abort_at_the_same_time_too(self):
        for share in [WHILE_READING, WHILE_COMPUTING]:
            for time in [0, 1]:
                filter = self.aborted(share)
                self.assertGreater(point_array(at(filter, time), "roi").sum(), 0)
                self.assertEqual(decompositions(filter), 1)

    def test_reads_again_after_an_abort(self):
        source = simple.mimetraSequence(FileName=str(self.sample.head))
        algorithm = source.GetClientSideObject()
        observer = algorithm.AddObserver("ProgressEvent", lambda *_: algorithm.SetAbortExecute(1))
        source.FileName = str(self.sample.take)
        with Messages() as messages:
            self.assertEqual(at(source, 0).GetNumberOfPoints(), 0)
        self.assertEqual(messages.text, "")
        algorithm.RemoveObserver(observer)
        self.assert_same(points(at(source, 0)), np.load(self.sample.take)[0])
        source.UpdatePipelineInformation()
        self.assertEqual(len(source.TimestepValues), 12)


if __name__ == "__main__":
    run_tests()
