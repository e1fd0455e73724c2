"""Operations whose filters are made of the table alone: meshes, tables and reports of the command."""

import csv
import shutil
import unittest

from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from host import *


def rotation(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def texts(table, name):
    column = table.GetColumnByName(name)
    return [column.GetValue(i) for i in range(column.GetNumberOfValues())]


def time_steps(filter):
    info = filter.GetClientSideObject().GetOutputInformation(0)
    return list(info.Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or [])


class Operations(HostTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # The take, which also turns and goes away.
        cls.moved = cls.sample / "moved.npy"
        take = np.load(cls.sample.take)
        np.save(cls.moved, np.stack([pose @ rotation(0.1 * frame).T + [0, frame, -frame]
                                     for frame, pose in enumerate(take)]))
        shutil.copy(cls.sample / "take.topology.ply", cls.sample / "moved.topology.ply")

    def sequence_of(self, path):
        source = simple.mimetraSequence(FileName=str(path))
        source.UpdatePipelineInformation()
        return source

    def test_align_shows_the_moving_input_without_its_head_motion(self):
        still = self.sample / "still.npy"
        mimetra("align", self.moved, "-o", still)
        source, expected = self.sequence_of(self.moved), self.sequence_of(still)
        align = simple.mimetraAlign(Input=source)
        for time in source.TimestepValues:
            self.assert_same(points(at(align, time)), points(at(expected, time)))
        self.assertEqual(time_steps(align), list(source.TimestepValues))
        self.assertGreater(np.abs(points(at(align)) - points(at(source))).max(), 1)

    def test_simplify_and_subdivide_show_meshes_of_their_own(self):
        source = self.sequence_of(self.moved)
        for name, filter in (("simplify", simple.mimetraSimplify(Input=source, Share=0.3)),
                             ("subdivide", simple.mimetraSubdivide(Input=source))):
            out = self.sample / f"{name}.npy"
            mimetra(name, self.moved, *(["--share", "0.3"] if name == "simplify" else []), "-o", out)
            expected = self.sequence_of(out)
            for time in source.TimestepValues:
                self.assert_same(points(at(filter, time)), points(at(expected, time)))

    def test_align_gives_back_the_motion_of_the_commands_manifest(self):
        mimetra("align", self.moved, "-o", self.sample / "kept.npy")
        self.assert_undone(self.sequence_of(self.moved), str(self.sample / "kept.run.json"))

    def test_align_gives_back_the_motion_of_its_own_manifest(self):
        run = self.sample / "align.json"
        self.assert_undone(self.sequence_of(self.moved), str(run), RunFile=str(run))
        manifest = json.loads(run.read_text())
        self.assertEqual((manifest["command"], manifest["options"]["on"]), ("align", "stable"))
        self.assertEqual(len(manifest["result"]["motion"]), 12)

    def test_a_further_run_replaces_the_manifest_and_nothing_else(self):
        run = self.sample / "replaced.json"
        align = simple.mimetraAlign(Input=self.sequence_of(self.moved), RunFile=str(run))
        at(align)
        align.On = "all"
        at(align)
        self.assertEqual(json.loads(run.read_text())["options"]["on"], "all")
        run.write_text("mine")
        align.On = "stable"
        with Messages() as messages:
            self.assertEqual(at(align).GetNumberOfPoints(), 0)
        self.assertIn(f"{run}: ", messages.text)
        self.assertEqual(run.read_text(), "mine")

    def assert_undone(self, source, manifest, **properties):
        back = simple.mimetraAlign(Input=simple.mimetraAlign(Input=source, **properties),
                                   Undo=manifest)
        # Both ways there is a product of rounded numbers, some units in the last place each.
        for time in source.TimestepValues:
            np.testing.assert_allclose(points(at(back, time)), points(at(source, time)), rtol=0,
                                       atol=1e-12 * np.abs(np.load(self.moved)).max())

    def test_align_refuses_the_manifest_of_another_run(self):
        mimetra("regions", self.sample.take, "-k", 3, "-o", self.sample / "regions.json")
        align = simple.mimetraAlign(Input=self.sequence_of(self.moved),
                                    Undo=str(self.sample / "regions.run.json"))
        with Messages() as messages:
            self.assertEqual(at(align).GetNumberOfPoints(), 0)
        self.assertIn("expected the manifest of an align run", messages.text)

    def test_info_is_a_table_of_the_report_and_a_message(self):
        with Messages() as messages:
            table = at(simple.mimetraInfo(Input=self.sequence_of(self.sample.take)))
        self.assertTrue(table.IsA("vtkTable"))
        self.assertEqual(table.GetNumberOfColumns(), 2)
        found = dict(zip(texts(table, "name"), map(json.loads, texts(table, "value")), strict=True))
        self.assertEqual(found, json.loads(mimetra("info", self.sample.take, "--json")))
        self.assertIn(mimetra("info", self.sample.take), messages.text)

    def odd(self):
        """A square with a point that no face uses."""
        positions, quads = grid()
        source = simple.TrivialProducer()
        source.GetClientSideObject().SetOutput(mesh_of(np.vstack([positions, [[9, 9, 9]]]), quads))
        return source

    def test_check_warns_of_what_is_odd(self):
        with Messages() as messages:
            table = at(simple.mimetraCheck(Input=self.odd()))
        words = "1 vertex without a face (in no region), the first is 36"
        self.assertIn(words, messages.text)
        self.assertIn("usable, 1 frame of 37 vertices, 1 warning", messages.text)
        self.assertEqual(texts(table, "name"), ["usable", "warnings"])
        self.assertEqual(texts(table, "value"), ["true", json.dumps([words])])

    def test_check_fails_in_the_output_window(self):
        with Messages() as messages:
            table = at(simple.mimetraCheck(Input=self.odd(), Strict=1))
        self.assertEqual(table.GetNumberOfRows(), 0)
        self.assertEqual(messages.text.count("ERR"), 1, messages.text)
        self.assertIn("1 vertex without a face", messages.text)

    def assert_evaluates(self, target, **inputs):
        """The table of the command for a target, in all columns but times."""
        path = self.sample / f"{self._testMethodName}.csv"
        mimetra("evaluate", self.sample.take, target, "-k", "3,6", "-o", path)
        table = at(simple.mimetraEvaluate(Input=self.sequence_of(self.sample.take), K="3,6",
                                          **inputs))
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([table.GetColumnName(i) for i in range(table.GetNumberOfColumns())],
                         list(rows[0]))
        words = table.GetColumnByName("by")
        self.assertEqual([words.GetValue(i) for i in range(words.GetNumberOfTuples())],
                         [row.pop("by") for row in rows])
        for name in rows[0]:
            if name.endswith("_seconds"):
                continue
            self.assert_same(column(table, name),
                             np.array([float(row[name] or "nan") for row in rows]), name)

    def test_evaluate_measures_the_transfer_to_a_model(self):
        target = f"{self.sample.head}@identity002=1"
        self.assert_evaluates(target, TargetFile=target)

    def test_evaluate_measures_the_transfer_to_a_mesh_of_the_pipeline(self):
        target = self.sample / "target.ply"
        mimetra("convert", f"{self.sample.head}@identity002=1", "-o", target)
        self.assert_evaluates(target, Target=self.sequence_of(target))

    def test_evaluate_asks_for_a_target(self):
        with Messages() as messages:
            at(simple.mimetraEvaluate(Input=self.sequence_of(self.sample.take)))
        self.assertIn("Target: expected a mesh at the port Target, or a model as Target File, found "
                      "nothing", messages.text)

    def test_tables_and_reports_are_shown_as_rows(self):
        for filter in [simple.mimetraInfo, simple.mimetraEvaluate]:
            hints = filter(Input=simple.Sphere()).SMProxy.GetHints()
            self.assertEqual(hints.FindNestedElementByName("View").GetAttribute("type"),
                             "SpreadSheetView")

    def test_comes_back_with_a_saved_state(self):
        info = simple.mimetraInfo(Input=self.sequence_of(self.sample.take))
        simple.mimetraAlign(Input=self.sequence_of(self.moved), On="all")
        expected = texts(at(info), "value")
        state = str(self.sample / "state.pvsm")
        simple.SaveState(state)
        simple.ResetSession()
        simple.LoadState(state)
        self.assertEqual(texts(at(simple.FindSource("mimetraInfo1")), "value"), expected)
        self.assertEqual(simple.FindSource("mimetraAlign1").On, "all")


if __name__ == "__main__":
    run_tests()
