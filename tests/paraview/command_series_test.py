"""ParaView opens what the command writes, without the plugin."""

import unittest

from host import *


class CommandSeries(HostTest):
    def test_opens_with_all_times_and_fields(self):
        regions = self.sample / "regions.pvd"
        report = json.loads(mimetra("transfer", self.sample.take, f"{self.sample.head}@identity002=1",
                                    "-k", 8, "-o", self.sample / "out", "--regions-out", regions,
                                    "--json"))["regions"]
        count = len(report["regions"])
        series = simple.OpenDataFile(str(regions))
        times = list(series.TimestepValues)
        np.testing.assert_allclose(times, np.arange(12) / 3, rtol=1e-9)
        rest = np.load(self.sample.take)[0]
        for time, frame in zip(times, np.load(self.sample.take)):
            mesh = at(series, time)
            self.assert_same(points(mesh), frame.astype(np.float32))
            region, covered = point_array(mesh, "region"), point_array(mesh, "region_count")
            roi, in_l = point_array(mesh, "roi"), cell_array(mesh, "in_L")
            self.assertEqual((region.min(), region.max()), (-1, count - 1))
            self.assertEqual((covered.min(), set(roi), set(in_l)), (0, {0, 1}, {0, 1}))
            self.assertTrue(1 <= covered.max() <= count)
            self.assertEqual(roi.sum(), report["vertices"])
            self.assertTrue(((region >= 0) == (roi == 1)).all())
            self.assertTrue(((covered > 0) == (roi == 1)).all())
            moved = point_array(mesh, "displacement")
            self.assertTrue((np.abs(moved).max() > 0) == (time > 0) or time == 0)
            np.testing.assert_allclose(point_array(mesh, "displacement_length"),
                                       np.linalg.norm(moved, axis=1), rtol=1e-6)
        names = mesh.GetPointData().GetArray("displacement")
        self.assertEqual([names.GetComponentName(i) for i in range(3)], ["X", "Y", "Z"])


if __name__ == "__main__":
    run_tests()
