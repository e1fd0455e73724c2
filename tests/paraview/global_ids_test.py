"""A mesh with global ids: what the command gives, on any number of processes. On several, a mesh
without them is refused."""

import unittest

from host import *

ALONE = servermanager.ActiveConnection.GetNumberOfDataPartitions() == 1


class GlobalIds(HostTest):
    def pieces(self):
        """The take as one process has it, or in pieces, with ghosts and without."""
        take = numbered(simple.mimetraSequence(FileName=str(self.sample.take)))
        return [take] if ALONE else [distributed(take), with_ghosts(take)]

    def assert_command_fields(self, expected, found, on_points, on_cells=()):
        count = expected.GetNumberOfPoints()
        for name in on_points:
            values = self.by_id(point_array(found, name), point_array(found, "number"), count)
            self.assert_same(values, point_array(expected, name), name)
        for name in on_cells:
            values = self.by_id(cell_array(found, name), cell_array(found, "GlobalCellIds"),
                                expected.GetNumberOfCells())
            self.assert_same(values, cell_array(expected, name), name)

    def test_distances_are_those_of_the_command(self):
        vtp = self.sample / "distance.vtp"
        mimetra("geodesic", self.sample.take, "--frames", "0:1", "--source", "100,2000", "-o", vtp)
        expected = fetched(simple.XMLPolyDataReader(FileName=[str(vtp)]))
        for source in self.pieces():
            found = fetched(simple.GeodesicDistance(Input=source, Source="100,2000"))
            self.assert_command_fields(expected, found, ["distance", "support"])

    def test_regions_are_those_of_the_command(self):
        pvd = self.sample / "regions.pvd"
        mimetra("regions", self.sample.take, "-k", 5, "-o", pvd)
        series = simple.PVDReader(FileName=str(pvd))
        series.UpdatePipelineInformation()
        for source in self.pieces():
            filter = simple.RegionsofInterest(Input=source, K=5)
            for time in list(series.TimestepValues)[:4:3]:
                self.assert_command_fields(fetched(series, time), fetched(filter, time),
                                           ["region", "region_count", "roi", "displacement"],
                                           ["in_L"])
            self.assertEqual(decompositions(filter), 1)

    def test_only_pieces_need_them(self):
        take = simple.mimetraSequence(FileName=str(self.sample.take))
        for name in ["GeodesicDistance", "RegionsofInterest"]:
            whole = fetched(getattr(simple, name)(Input=take))
            self.assertEqual(whole.GetNumberOfPoints(), fetched(take).GetNumberOfPoints())
            if ALONE:
                continue
            filter = getattr(simple, name)(Input=distributed(take))
            with Messages() as messages:
                self.assertEqual(fetched(filter).GetNumberOfPoints(), 0)
            self.assertIn("process 0 has a piece of the mesh without global ids; apply the filter "
                          "Generate Global Ids before distributing it", messages.text)
            self.assertEqual(messages.text.count("ERR"), 1, messages.text)


if __name__ == "__main__":
    run_tests()
