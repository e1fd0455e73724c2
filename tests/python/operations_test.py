"""Operations on arrays: the results of the command, bit for bit."""

import csv
import json
import os
import subprocess
import sys
import unittest

import mimetra
import numpy as np
from sample import SampleTest, command


class Operations(SampleTest):
    def test_transfers_to_a_model_as_the_command_does(self):
        out, weights = self.path / "model.npy", self.path / "weights.csv"
        command("transfer", self.take, self.actor, "-k", 12, "-o", out, "--weights-out", weights)
        actor = mimetra.Model.load(self.actor)
        target = mimetra.Model(actor.neutral, actor.faces, actor.expressions,
                               actor.expression_names)
        result = mimetra.transfer(self.arrays, target, k=12, weights_out=True)
        self.assert_same(result.out.positions, np.load(out))
        with open(weights, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertGreater(len(rows[0]), 12)
        for name in rows[0]:
            self.assert_same(result.weights_out[name], np.array([float(row[name]) for row in rows]),
                             name)
        self.assertIsNone(result.regions_out)

    def test_transfers_to_a_mesh_as_the_command_does(self):
        mesh, out = self.path / "mesh.ply", self.path / "vertices.npy"
        command("convert", self.actor, "-o", mesh)
        command("transfer", self.take, mesh, "-k", 12, "-o", out)
        still = mimetra.Sequence.load(mesh)
        result = mimetra.transfer(self.arrays, (still.positions[0], still.faces), k=12)
        self.assert_same(result.out.positions, np.load(out))

    def test_paints_by_a_field_as_the_command_does_by_a_list(self):
        count = self.arrays.rest.shape[0]
        lips = np.select([np.arange(count) < count // 3, np.arange(count) < count // 2],
                         [1.0, 0.25], 0.0)
        listed, out = self.path / "lips.txt", self.path / "painted.npy"
        np.savetxt(listed, lips)
        regions = self.path / "painted.json"
        command("transfer", self.take, self.actor, "--paint", listed, "--falloff", 0.05, "-o", out,
                "--regions-out", regions)
        painted = mimetra.Sequence(self.arrays.positions, self.arrays.faces, self.arrays.times,
                                   self.arrays.rest, on_vertices={"lips": lips})
        result = mimetra.transfer(painted, self.actor, paint="field:lips", falloff=0.05,
                                  regions_out=True)
        self.assert_same(result.out.positions, np.load(out))
        expected = np.array(json.loads(regions.read_text())["weights"])
        self.assert_same(np.asarray(result.out.weight), expected)
        self.assert_same(np.asarray(result.regions_out.weight), expected)
        self.assertEqual(result.report["targets"][0]["weight"]["one"], int((expected == 1).sum()))
        with self.assertRaisesRegex(mimetra.Mismatch, "field 'lip' is not there"):
            mimetra.transfer(painted, self.actor, paint="field:lip")

    def test_a_model_with_identities_stands_for_its_mean_as_a_target(self):
        out = self.path / "mean.npy"
        command("transfer", self.take, self.head, "-k", 4, "-o", out)
        model = mimetra.Model.load(self.head)
        self.assertIn("identities", model)
        result = mimetra.transfer(self.arrays, model, k=4)
        self.assert_same(result.out.positions, np.load(out))

    def test_fields_of_a_sequence_do_not_change_what_looks_at_none(self):
        shown = mimetra.geodesic(self.arrays, source=[3]).out
        self.assertTrue(mimetra.operations["geodesic"].outputs[0].fields)
        self.assertFalse(mimetra.operations["check"].inputs[0].fields)
        self.assertTrue(mimetra.operations["decompose"].inputs[0].fields)
        bare = mimetra.Sequence(shown.positions, shown.faces, shown.times, shown.rest)
        self.assertEqual(mimetra.check(shown).report, mimetra.check(bare).report)

    def test_info_lists_the_fields_of_a_sequence(self):
        shown = mimetra.geodesic(self.arrays, source=[3]).out
        self.assertEqual(mimetra.info(shown).report["fields"],
                         [{"name": "distance", "on": "vertices", "numbers": 1},
                          {"name": "support", "on": "vertices", "numbers": 1}])
        self.assertNotIn("fields", mimetra.info(self.arrays).report)

    def test_a_list_of_targets_gives_lists(self):
        out = self.path / "results"
        command("transfer", self.take, self.actor, self.head, "--full", "-o", out)
        result = mimetra.transfer(self.arrays, [self.actor, self.head], full=True)
        self.assertEqual([target["name"] for target in result.report["targets"]],
                         [sequence.name for sequence in result.out])
        self.assertEqual(len(result.out), 2)
        self.assertFalse(np.array_equal(result.out[0].positions, result.out[1].positions))

    def test_finds_the_regions_of_the_command(self):
        out = self.path / "regions.json"
        report = json.loads(command("regions", self.take, "-k", 8, "-o", out, "--json"))
        result = mimetra.regions(self.arrays, k=8)
        self.assertEqual(result.report["regions"], report["regions"])
        self.assertEqual(result.out.centers.tolist(), [r["center"] for r in report["regions"]])
        with open(out) as file:
            self.assertEqual(json.loads(result.out.json)["regions"], json.load(file)["regions"])

    def test_regions_go_on_into_a_transfer(self):
        regions, out = self.path / "four.json", self.path / "four.npy"
        command("regions", self.take, "-k", 4, "-o", regions)
        command("transfer", self.take, self.actor, "--regions", regions, "-o", out)
        found = mimetra.regions(self.arrays, k=4).out
        result = mimetra.transfer(self.arrays, self.actor, regions=found)
        self.assert_same(result.out.positions, np.load(out))
        painted = mimetra.Regions(found.masks, self.arrays.faces)
        result = mimetra.transfer(self.arrays, self.actor, regions=painted)
        self.assert_same(result.out.positions, np.load(out))

    def test_says_what_a_sequence_is_and_whether_it_can_be_used(self):
        for found, name in [(mimetra.info(self.arrays), "info"),
                            (mimetra.check(self.arrays), "check")]:
            self.assertEqual(found.report, json.loads(command(name, self.take, "--json")))
            self.assertGreater(len(found.summary), 0)

    def test_aligns_and_gives_the_motion_back(self):
        out = self.path / "still.npy"
        command("align", self.take, "--on", "all", "-o", out)
        still = mimetra.align(self.arrays, on="all").out
        self.assert_same(still.positions, np.load(out))
        back = mimetra.align(still, undo=self.path / "still.run.json").out
        # Both ways there is a product of rounded numbers, some units in the last place each.
        np.testing.assert_allclose(back.positions, self.arrays.positions, rtol=0,
                                   atol=1e-12 * np.abs(self.arrays.positions).max())

    def test_converts_to_the_same_frames(self):
        result = mimetra.convert(self.take)
        self.assert_same(result.out.positions, self.arrays.positions)
        self.assertEqual(result.report["frames"], 12)

    def test_simplifies_and_subdivides_as_the_command_does(self):
        coarse, fine = self.path / "coarse.npy", self.path / "fine.npy"
        report = json.loads(command("simplify", self.take, "--share", "0.3", "-o", coarse, "--json"))
        result = mimetra.simplify(self.arrays, share=0.3)
        self.assert_same(result.out.positions, np.load(coarse))
        self.assertEqual(result.report["kept"], report["kept"])
        self.assert_same(result.out.positions, self.arrays.positions[:, report["kept"]])
        command("subdivide", self.take, "--scheme", "midpoint", "-o", fine)
        self.assert_same(mimetra.subdivide(self.arrays, scheme="midpoint").out.positions,
                         np.load(fine))

    def test_evaluates_as_the_command_does(self):
        out = self.path / "table.csv"
        command("evaluate", self.take, self.actor, "-k", "3,6", "-o", out)
        table = mimetra.evaluate(self.arrays, self.actor, k=[3, 6], out=True).out
        with open(out, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(table["by"], ["energy", "energy", ""])
        self.assertEqual(table["by"], [row.pop("by") for row in rows])
        for name in rows[0]:
            if not name.endswith("_seconds"):
                self.assert_same(table[name], np.array([float(row[name] or "nan") for row in rows]),
                                 name)

    def test_retargets_weights_as_the_command_does(self):
        track, out, kept = (self.path / name for name in ["rig.csv", "double.csv", "map.json"])
        names = mimetra.Model.load(self.actor).expression_names
        times = np.linspace(0, 1, 5)
        columns = {"time": times,
                   **{name: times * (number % 3) / 3 for number, name in enumerate(names)}}
        np.savetxt(track, np.array([*columns.values()]).T, fmt="%.17g", delimiter=",",
                   header=",".join(columns), comments="")
        command("retarget", self.actor, self.head, "--weights", track, "-o", out,
                "--map-out", kept)
        result = mimetra.retarget(source=self.actor, target=self.head,
                                  weights=mimetra.Table(columns))
        again = mimetra.retarget(weights=track, map=kept)
        with open(out, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertGreater(len(rows[0]), 12)
        for name in rows[0]:
            self.assert_same(result.out[name], np.array([float(row[name]) for row in rows]), name)
            # The map is linear at the neutral; the weights are below 1.
            self.assertLess(np.abs(again.out[name] - result.out[name]).max(), 0.1)
        percent = {name: column if name == "time" else 100 * column
                   for name, column in columns.items()}
        with self.assertRaisesRegex(mimetra.Error, "weight_scale"):
            mimetra.retarget(source=self.actor, target=self.head, weights=mimetra.Table(percent))
        divided = mimetra.retarget(source=self.actor, target=self.head,
                                   weights=mimetra.Table(percent), weight_scale=0.01)
        np.testing.assert_allclose(divided.out[names[1]], result.out[names[1]], atol=1e-12)

    def test_fits_as_the_command_does(self):
        lines = (self.head / "landmarks68.txt").read_text().splitlines()
        pairs = [tuple(map(int, line.split("="))) for line in lines if line[:1].isdigit()]
        points = np.full((3, 68, 2), np.nan)
        for landmark, vertex in pairs:
            points[:, landmark - 1] = self.arrays.positions[:3, vertex, :2] * [1, -1] + 300
        track, out = self.path / "track.csv", self.path / "fit.npy"
        names = ",".join(f"x{landmark},y{landmark}" for landmark in range(68))
        np.savetxt(track, points.reshape(3, -1), delimiter=",", header=names, comments="",
                   fmt="%.17g")
        command("fit", track, "--model", self.head, "-o", out)
        self.assert_same(mimetra.fit(track, model=self.head).out.positions, np.load(out))

    def test_makes_the_sample(self):
        sample = mimetra.sample().out
        model = mimetra.Model.load(self.head)
        # The command's files of meshes are in single precision.
        np.testing.assert_array_equal(sample.neutral.astype(np.float32),
                                      model.neutral.astype(np.float32))
        self.assertEqual(len(sample.weights), 120)

    def test_makes_a_rig_as_the_command_does(self):
        mesh, out = self.path / "bare.ply", self.path / "rig"
        command("convert", self.actor, "-o", mesh, "--double")
        command("rig", self.head, mesh, "-o", out)
        made = mimetra.Model.load(out)
        result = mimetra.rig(self.head, mesh)
        self.assertEqual(list(result.out.expression_names), list(made.expression_names))
        self.assertEqual(len(result.report["expressions"]), 12)
        # Shapes in files are absolute: displacements lose what the positions round.
        np.testing.assert_allclose(result.out.expressions, made.expressions, atol=1e-12)

    def test_parameters_are_numbers_text_paths_and_lists(self):
        rest, out = self.path / "rest.ply", self.path / "aligned.npy"
        command("convert", f"{self.head}@identity001=1", "-o", rest)
        command("transfer", self.take, self.actor, "-k", 5, "--radius", "12abs", "--source-rest",
                rest, "-o", out)
        result = mimetra.transfer(self.arrays, self.actor, k=np.int32(5), radius="12abs",
                                  source_rest=rest)
        self.assert_same(result.out.positions, np.load(out))
        fields = mimetra.geodesic(self.arrays, source=[3, 70], d_max=0.5).out
        self.assertEqual(np.flatnonzero(fields.distance == 0).tolist(), [3, 70])
        self.assertEqual(fields.location("support"), "vertices")

    def test_results_do_not_depend_on_threads(self):
        one = mimetra.decompose(self.arrays, k=5, threads=1).out
        two = mimetra.decompose(self.arrays, k=5, threads=2).out
        self.assert_same(one.displacements, two.displacements)
        self.assert_same(one.weights, two.weights)

    def test_a_path_for_an_output_is_where_the_command_writes_it(self):
        asked, written = self.path / "asked", self.path / "written"
        command("align", self.take, "--on", "all", "--format", "obj", "-o", asked)
        result = mimetra.align(self.take, on="all", format="obj", out=written)
        self.assertEqual(sorted(os.listdir(asked)), sorted(os.listdir(written)))
        for name in os.listdir(asked):
            if name.endswith(".obj"):
                self.assertEqual((asked / name).read_bytes(), (written / name).read_bytes())
        with open(written / "mimetra-run.json") as file:
            manifest = json.load(file)
        self.assertEqual(manifest["result"], result.report)
        self.assertEqual(manifest["named_inputs"], {"sequence": [str(self.take)]})
        with self.assertRaisesRegex(mimetra.OutputError, "written"):
            mimetra.align(self.take, out=written)
        self.assertEqual(mimetra.align(self.take, out=written, force=True).report["frames"], 12)

    def test_a_manifest_gives_motion_back(self):
        manifest = self.path / "align.json"
        still = mimetra.align(self.arrays, on="all", manifest=manifest).out
        self.assertGreater(np.abs(still.positions - self.arrays.positions).max(), 1e-6)
        moving = mimetra.align(still, undo=manifest).out
        self.assertLess(np.abs(moving.positions - self.arrays.positions).max(), 1e-12)

    def test_an_operation_is_found_by_its_name(self):
        self.assertEqual(mimetra.run("info", self.arrays).report["frames"], 12)
        with self.assertRaisesRegex(mimetra.UsageError, "no operation 'inof'; there are info,"):
            mimetra.run("inof", self.arrays)

    def test_a_library_that_is_told_is_used(self):
        done = subprocess.run([sys.executable, "-c", "import mimetra"], capture_output=True,
                              text=True, env={**os.environ,
                                              "MIMETRA_LIBRARY": "/nowhere/libmimetra_c.so"})
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("set MIMETRA_LIBRARY to the path of libmimetra_c.so", done.stderr)


if __name__ == "__main__":
    unittest.main()
