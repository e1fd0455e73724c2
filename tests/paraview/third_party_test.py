"""Operations of plugins: filters with their parameters, and the command's results."""

import unittest

from host import *


class ThirdPartyOperations(HostTest):
    def setUp(self):
        self.source = simple.mimetraSequence(FileName=str(self.sample.take))
        self.source.UpdatePipelineInformation()

    def test_has_the_parameters_of_the_plugin(self):
        smooth = simple.mimetraSmooth(Input=self.source)
        self.assertEqual(smooth.Strength, 0.5)
        self.assertEqual(smooth.Iterations, 1)

    def test_has_the_ranges_of_the_plugin(self):
        smooth = simple.mimetraSmooth(Input=self.source)
        for name, kind, ends in [("Iterations", "Int", (1, 1000000)), ("Strength", "Double", (0, 1))]:
            range = smooth.GetProperty(name).FindDomain(f"vtkSM{kind}RangeDomain")
            self.assertTrue(range.GetMinimumExists(0) and range.GetMaximumExists(0))
            self.assertEqual((range.GetMinimum(0), range.GetMaximum(0)), ends)

    def test_smooths_as_the_command_does(self):
        smooth = simple.mimetraSmooth(Input=self.source, Strength=0.3, Iterations=2)
        array = self.sample / "smooth.npy"
        mimetra("smooth", self.sample.take, "--strength", 0.3, "--iterations", 2, "-o", array)
        expected = simple.mimetraSequence(FileName=str(array))
        expected.UpdatePipelineInformation()
        for time in self.source.TimestepValues:
            self.assert_same(points(at(smooth, time)), points(at(expected, time)))
        before = points(at(smooth))
        smooth.Strength = 1
        self.assertFalse(np.array_equal(points(at(smooth)), before))

    def test_shows_the_fields_of_the_command(self):
        speed = simple.mimetraSpeed(Input=self.source)
        mimetra("speed", self.sample.take, "-o", self.sample / "speed.pvd")
        expected = at(simple.PVDReader(FileName=str(self.sample / "speed.pvd")))
        found = at(speed)
        for name in ["speed", "top_speed"]:
            shown = point_array(found, name)
            self.assertGreater(shown.max(), 0)
            self.assert_same(shown, point_array(expected, name), name)

    def test_tells_of_what_fails(self):
        with Messages() as messages:
            at(simple.mimetraSpeed(Input=simple.Sphere()))
        self.assertIn("speed sample: speed: one frame has no speed", messages.text)


if __name__ == "__main__":
    unittest.main()
