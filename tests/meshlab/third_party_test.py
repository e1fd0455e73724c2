"""Operations of plugins: filters with their parameters, and the command's results."""

import unittest

from host import *


class ThirdPartyOperations(HostTest):
    def test_smooth_makes_layers(self):
        out = self.path / "smooth.npy"
        mimetra("smooth", self.path / "take", "--strength", 0.25, "-o", out)
        expected = np.load(out).astype("f4")
        script = filter_script("mimetra Smooth", strength=0.25)
        for layer, pose in zip(self.new_layers(self.take, script, 12), expected, strict=True):
            self.assert_same(layer.points, pose)

    def test_speed_is_the_quality_of_the_frames(self):
        mimetra("speed", self.path / "take", "-o", self.path / "speed.pvd")
        expected = Fields(next(self.path.glob("speed*/*.vtp")))
        for field, shown in [("", "speed"), ("top_speed", "top_speed")]:
            script = filter_script("mimetra Speed", Field=field)
            outputs = [(f"quality{i}.ply", i, "vq") for i in [0, 11]]
            for layer in self.apply(self.take, [script], outputs):
                self.assert_same(layer.vertices["quality"],
                                 expected.on_vertices(shown).astype("f4"))

    def test_speed_refuses_a_field_that_it_does_not_make(self):
        self.assert_refused(self.take, [filter_script("mimetra Speed", Field="heat")], "heat")


if __name__ == "__main__":
    unittest.main()
