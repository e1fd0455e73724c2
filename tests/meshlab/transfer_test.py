"""Region Transfer: the meshes of `mimetra transfer` as new layers."""

import unittest

from host import *


class RegionTransfer(HostTest):
    def expected(self, *arguments):
        """What the command writes, in MeshLab's single precision."""
        out = self.path / f"{self._testMethodName}.npy"
        mimetra("transfer", *arguments, "-o", out)
        return np.load(out).astype("f4")

    def assert_layers(self, layers, script, expected, mask=""):
        """The result's layers come after those that were opened."""
        numbers = [len(layers) + i for i in [0, 4, len(expected) - 1]]
        outputs = [(f"layer{i}.ply", i, mask) for i in numbers]
        found = self.apply(layers, [script], outputs)
        for number, layer in zip(numbers, found, strict=True):
            self.assert_same(layer.points, expected[number - len(layers)], f"layer {number}")
        return found

    def test_moves_the_current_layer_as_files_do(self):
        expected = self.expected(self.path / "take", self.target, "-k", 12)
        script = filter_script("Region Transfer", k=12, source=self.path / "take")
        self.assert_layers([self.target], script, expected)

    def test_moves_the_current_layer_as_the_others_do(self):
        expected = self.expected(self.path / "take", self.target, "-k", 12, "--outside", "identity",
                                 "--outside-weight", 0.3)
        script = filter_script("Region Transfer", k=12,
                               options="--outside identity --outside-weight 0.3")
        self.assert_layers([*self.take, self.target], script, expected)

    def test_solves_for_the_blendshapes_of_a_model(self):
        weights = self.path / "weights.csv"
        expected_weights = self.path / "expected.csv"
        expected = self.expected(self.path / "take", self.model, "-k", 12, "--weights-out",
                                 expected_weights)
        script = filter_script("Region Transfer", k=12, target=self.model,
                               options=f"--weights-out {weights}")
        found = self.assert_layers(self.take, script, expected)
        self.assertEqual(len(found[0].faces), len(Ply(self.target_in_triangles()).faces))
        self.assertEqual(weights.read_text(), expected_weights.read_text())

    def target_in_triangles(self):
        self.apply([self.target], [], [("triangles.ply", 0, "")])
        return self.path / "triangles.ply"

    def test_uses_all_triangles_where_asked(self):
        expected = self.expected(self.path / "take", self.model, "--full")
        script = filter_script("Region Transfer", full=True, target=self.model)
        self.assert_layers(self.take, script, expected)

    def test_measures_from_a_given_rest_pose(self):
        expected = self.expected(self.path / "take", self.model, "--full", "--source-rest",
                                 self.rest)
        script = filter_script("Region Transfer", full=True, target=self.model,
                               source_rest=self.rest)
        self.assert_layers(self.take, script, expected)

    def test_warns_where_the_first_frame_stands_in_for_the_rest_pose(self):
        done = self.serve(self.take, [filter_script("Region Transfer", full=True,
                                                    target=self.model)])
        self.assertIn("first frame", done.stdout)

    def test_shows_the_regions_on_the_new_layers(self):
        regions = self.path / "shown.vtp"
        expected = self.expected(self.path / "take", self.target, "-k", 12, "--regions-out",
                                 regions)
        script = filter_script("Region Transfer", k=12, source=self.path / "take")
        region = Fields(regions).on_vertices("region").astype("f4")
        for layer in self.assert_layers([self.target], script, expected, "vq"):
            self.assert_same(layer.vertices["quality"], region)

    def test_takes_a_region_set(self):
        regions = self.path / "lips.json"
        mimetra("regions", self.path / "take", "-k", 4, "-o", regions)
        expected = self.expected(self.path / "take", self.model, "--regions", regions)
        script = filter_script("Region Transfer", target=self.model,
                               options=f"--regions {regions}")
        self.assert_layers(self.take, script, expected)

    def test_keeps_polygons_of_any_size(self):
        ring = [(np.cos(a), np.sin(a)) for a in 2 * np.pi * np.arange(7) / 7]
        faces = [list(range(7)), [*range(13, 6, -1)],
                 *[[i, 7 + i, 7 + (i + 1) % 7, (i + 1) % 7] for i in range(7)]]
        for frame in range(3):
            points = [(x, y, 0) for x, y in ring]
            points += [(x, y, 1 + 0.1 * frame * (1 + x)) for x, y in ring]
            first = write_ply(self.path / "prism" / f"{frame}.ply", points, faces)
        expected = self.expected(self.path / "prism", first, "--full")
        for source in ["", self.path / "prism"]:
            layers = [*sorted((self.path / "prism").glob("*.ply")), first]
            script = filter_script("Region Transfer", full=True, source=source)
            [layer] = self.apply(layers, [script], [("prism.ply", len(layers) + 1, "")])
            self.assert_same(layer.points, expected[1])

    def test_can_follow_itself(self):
        """New layers are hidden, so that they do not become frames of a further run."""
        expected = self.expected(self.path / "take", self.model, "--full")
        scripts = [filter_script("Region Transfer", full=True, target=self.model)] * 2
        count = len(self.take)
        [last] = self.apply(self.take, scripts, [("last.ply", 3 * count - 1, "")])
        self.assert_same(last.points, expected[-1])


if __name__ == "__main__":
    unittest.main()
