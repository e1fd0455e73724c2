"""Regions of Interest: the region field of `mimetra regions` as quality, and a selection."""

import unittest

from host import *


class RegionsOfInterest(HostTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.vtp = cls.path / "regions.vtp"
        cls.json = cls.path / "regions.json"
        for out in [cls.vtp, cls.json]:
            mimetra("regions", cls.path / "take", "-k", 12, "-o", out)
        cls.region = Fields(cls.vtp).on_vertices("region").astype("f4")

    def test_is_the_region_field_of_the_visible_layers(self):
        outputs = [(f"layer{i}.ply", i, "vq") for i in [0, 5, 11]]
        for layer in self.apply(self.take, [filter_script("Regions of Interest", k=12)], outputs):
            self.assert_same(layer.vertices["quality"], self.region)
        self.assertEqual((self.region.min(), self.region.max()), (-1, 11))

    def test_is_what_the_sample_script_asks_for(self):
        sample = ElementTree.parse(SAMPLES / "meshlab_regions.mlx").getroot()
        [layer] = self.apply(self.take, list(sample), [("sample.ply", 0, "vq")])
        self.assert_same(layer.vertices["quality"], self.region)
        asked = [dict(row.attrib) for row in sample.iter("Param")]
        rows = [dict(row.attrib) for row in filter_script("Regions of Interest", k=12)]
        self.assertEqual(asked, rows)

    def test_takes_a_sequence_of_files_onto_the_current_layer(self):
        script = filter_script("Regions of Interest", k=12, sequence=self.path / "take")
        [layer] = self.apply([self.take[3]], [script], [("one.ply", 0, "vq")])
        self.assert_same(layer.vertices["quality"], self.region)

    def test_takes_a_model_with_weights_and_some_of_its_frames(self):
        out = self.path / "model.vtp"
        weights = self.head / "performance.csv"
        mimetra("regions", self.model, "--weights", weights, "--frames", "0:60:5", "-k", 6,
                "-o", out)
        script = filter_script("Regions of Interest", k=6, sequence=self.model,
                               options=f'--weights "{weights}" --frames=0:60:5')
        [layer] = self.apply([self.target], [script], [("model.ply", 0, "vq")])
        self.assert_same(layer.vertices["quality"], Fields(out).on_vertices("region").astype("f4"))

    def test_hands_parameters_of_every_kind_on(self):
        out = self.path / "other.vtp"
        mimetra("regions", self.path / "take", "-k", 9, "--radius", "20abs", "--sparsity", 1.7,
                "--signed", "--region", "support", "--coverage", 0.6, "--rest", "mean", "-o", out)
        script = filter_script("Regions of Interest", k=9, radius="20abs", region=1, coverage=0.6,
                               options="--sparsity 1.7 --signed --rest mean")
        [layer] = self.apply(self.take, [script], [("other.ply", 0, "vq")])
        self.assert_same(layer.vertices["quality"], Fields(out).on_vertices("region").astype("f4"))

    def test_selects_the_regions_and_their_triangles(self):
        [layer] = self.apply(self.take, [filter_script("Regions of Interest", k=12)],
                             [("selected.ply", 0, "vf ff")])
        selected = (layer.vertices["flags"] & SELECTED) != 0
        self.assert_same(selected, self.region >= 0)
        faces = {tuple(sorted(face["corners"])) for face in layer.faces if face["flags"] & SELECTED}
        regions = json.loads(self.json.read_text())
        self.assertEqual(len(faces), len(regions["triangles"]))
        self.assertTrue(all(selected[list(face)].any() for face in faces))

    def test_writes_the_components_and_reads_them_again(self):
        components = self.path / "components.h5"
        self.apply(self.take, [filter_script("Regions of Interest", k=12,
                                             options=f"--components-out {components}")],
                   [("first.ply", 0, "vq")])
        out = self.path / "from_components.vtp"
        mimetra("regions", self.path / "take", "--components", components, "--radius", 0.05,
                "-o", out)
        script = filter_script("Regions of Interest", radius="0.05",
                               options=f"--components {components}")
        [layer] = self.apply(self.take, [script], [("second.ply", 0, "vq")])
        self.assert_same(layer.vertices["quality"], Fields(out).on_vertices("region").astype("f4"))

    def test_says_what_it_found(self):
        done = self.serve(self.take, [filter_script("Regions of Interest", k=12)])
        self.assertIn("12 regions hold", done.stdout)


if __name__ == "__main__":
    unittest.main()
