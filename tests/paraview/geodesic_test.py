"""Geodesic Distance: the fields of `mimetra geodesic`, on the mesh of each time step."""

import unittest

from paraview import servermanager

from host import *


class GeodesicDistance(HostTest):
    def test_has_the_fields_of_the_command_at_every_time(self):
        source = simple.mimetraSequence(FileName=str(self.sample.take))
        source.UpdatePipelineInformation()
        filter = simple.GeodesicDistance(Input=source, Source="100,2000", DMax="0.5")
        for frame, time in enumerate(source.TimestepValues):
            vtp = self.sample / f"{frame}.vtp"
            mimetra("geodesic", self.sample.take, "--frames", f"{frame}:{frame + 1}", "--source",
                    "100,2000", "--d-max", 0.5, "-o", vtp)
            expected = at(simple.XMLPolyDataReader(FileName=[str(vtp)]))
            found = at(filter, time)
            for name in ["distance", "support"]:
                self.assert_same(point_array(found, name), point_array(expected, name), name)
            self.assertEqual(point_array(found, "distance")[100], 0)

    @unittest.skipIf(servermanager.ActiveConnection.GetNumberOfDataPartitions() > 1,
                     "a sphere comes in pieces: processes_test.py")
    def test_measures_on_a_mesh_without_times(self):
        sphere = simple.Sphere(ThetaResolution=64, PhiResolution=64)
        distance = point_array(at(simple.GeodesicDistance(Input=sphere)), "distance")
        # Half the circumference of the sphere of radius 0.5, by the heat method on this grid.
        self.assertAlmostEqual(distance[1], np.pi / 2, delta=0.05 * np.pi / 2)


if __name__ == "__main__":
    run_tests()
