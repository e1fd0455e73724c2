"""Operations whose filters are made of the table alone, on layers and files."""

import csv
import unittest

from host import *


class Operations(HostTest):
    def expected(self, *arguments):
        """The command's positions, in MeshLab's single precision."""
        out = self.path / f"{self._testMethodName}.npy"
        mimetra(*arguments, "-o", out)
        return np.load(out).astype("f4")

    def test_align_makes_layers_without_the_head_motion(self):
        expected = self.expected("align", self.path / "take", "--on", "all")
        found = self.new_layers(self.take, filter_script("mimetra Align", on=1), 12)
        for layer, pose in zip(found, expected, strict=True):
            self.assert_same(layer.points, pose)

    def test_align_gives_the_motion_of_a_manifest_back(self):
        expected = self.expected("align", self.path / "take")
        self.assertEqual(len(expected), 12)
        manifest = self.path / f"{self._testMethodName}.run.json"
        script = filter_script("mimetra Align", sequence=self.path / f"{self._testMethodName}.npy",
                               undo=manifest)
        for layer, frame in zip(self.new_layers([self.target], script, 12), self.take, strict=True):
            # Rounded to single precision, of a head of some hundred units, here and there.
            np.testing.assert_allclose(layer.points, Ply(frame).points, rtol=0, atol=1e-4)

    def test_align_writes_a_manifest_that_undoes_it(self):
        still = self.path / "still.npy"
        mimetra("align", self.path / "take", "-o", still)
        manifest = self.path / "manifest.json"
        script = filter_script("mimetra Align", Manifest=manifest)
        self.log(self.take, script)
        back = self.expected("align", still, "--undo", manifest)
        for pose, frame in zip(back, self.take, strict=True):
            # Layers, like frames, are in single precision.
            np.testing.assert_allclose(pose, Ply(frame).points, rtol=0, atol=1e-4)
        self.assert_refused(self.take, [script], "manifest.json: exists")

    def test_convert_opens_a_sequence_as_layers(self):
        out = self.path / "opened.npy"
        mimetra("convert", self.path / "take", "-o", out)
        script = filter_script("mimetra Convert", sequence=out)
        for layer, frame in zip(self.new_layers([self.target], script, 12), self.take, strict=True):
            self.assert_same(layer.points, Ply(frame).points)

    def test_simplify_and_subdivide_make_layers_of_other_vertices(self):
        for name, script in (
                ("simplify", filter_script("mimetra Simplify", share=0.3)),
                ("subdivide", filter_script("mimetra Subdivide", times=1))):
            options = ["--share", "0.3"] if name == "simplify" else []
            out = self.path / f"{name}d.npy"
            mimetra(name, self.path / "take", *options, "-o", out)
            expected = np.load(out).astype("f4")
            for layer, pose in zip(self.new_layers(self.take, script, 12), expected, strict=True):
                self.assert_same(layer.points, pose)

    def test_info_stands_in_the_log(self):
        said = self.log(self.take, filter_script("mimetra Info"))
        for line in mimetra("info", self.path / "take").splitlines():
            self.assertIn(line, said)

    def test_check_says_what_is_odd_and_refuses_it_when_strict(self):
        points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (5, 5, 5)]
        odd = write_ply(self.path / "odd.ply", points, [(0, 1, 2)])
        words = "1 vertex without a face (in no region), the first is 3"
        said = self.log([odd], filter_script("mimetra Check"))
        self.assertIn(words, said)
        self.assertIn("usable, 1 frame of 4 vertices, 1 warning", said)
        self.assert_refused([odd], [filter_script("mimetra Check", strict=True)], words)

    def test_decompose_writes_the_components_of_the_command(self):
        out, expected = self.path / "components.h5", self.path / "expected.h5"
        mimetra("decompose", self.path / "take", "-k", 6, "-o", expected)
        self.log(self.take, filter_script("mimetra Decompose", k=6, out=out))
        regions = []
        for components in [out, expected]:
            regions.append(components.with_suffix(".json"))
            mimetra("regions", self.path / "take", "--components", components, "-o", regions[-1])
        found, wanted = (json.loads(path.read_text())["regions"] for path in regions)
        self.assertEqual(found, wanted)
        self.assert_refused(self.take, [filter_script("mimetra Decompose", k=6, out=out)],
                            "components.h5: exists; choose another name")

    def test_decompose_asks_for_a_file(self):
        self.assert_refused(self.take, [filter_script("mimetra Decompose", k=6)],
                            "out: expected a file to write, the components: .h5 or .hdf5, found nothing")

    def test_evaluate_measures_the_transfer_to_the_current_layer(self):
        out, expected = self.path / "table.csv", self.path / "expected.csv"
        mimetra("evaluate", self.path / "take", self.target, "-k", "3,6", "-o", expected)
        said = self.log([*self.take, self.target],
                        filter_script("mimetra Evaluate", k="3,6", options=f"--out {out}"))
        self.assertIn("transfer s", said)
        tables = []
        for path in [out, expected]:
            with open(path, newline="") as file:
                tables.append([{name: text for name, text in row.items()
                                if not name.endswith("_seconds")} for row in csv.DictReader(file)])
        self.assertEqual(*tables)
        self.assertEqual(len(tables[0]), 3)


if __name__ == "__main__":
    unittest.main()
