"""The examples for clusters: every clip to every target, on two workers and as an array of jobs."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import unittest

from sample import SampleTest, command

CLUSTER = pathlib.Path(__file__).parents[2] / "samples" / "cluster"


class Clips(SampleTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.takes = cls.path / "takes"
        for name, frames in (("a", "0:60:10"), ("b", "60:120:10")):
            command("convert", f"{cls.head}@identity001=1", "--weights",
                    cls.head / "performance.csv", "--frames", frames, "-o", cls.takes / f"{name}.npy")
        cls.targets = [str(cls.head), f"{cls.head}@identity002=1"]
        cls.expected = cls.path / "expected"
        for clip in "ab":
            for target in cls.targets:
                command("transfer", cls.takes / f"{clip}.npy", target, "-k", "3", "-o",
                        cls.expected / f"{clip}_{pathlib.Path(target).name}.npy")

    def assert_expected(self, folder):
        expected = sorted(path.name for path in self.expected.glob("*.npy"))
        self.assertEqual(len(expected), 4)
        self.assertEqual(sorted(path.name for path in folder.glob("*.npy")), expected)
        for name in expected:
            self.assertEqual((folder / name).read_bytes(), (self.expected / name).read_bytes(), name)

    @unittest.skipUnless(importlib.util.find_spec("distributed"), "without python3-distributed")
    def test_on_two_workers(self):
        out = self.path / "dask"
        line = [sys.executable, CLUSTER / "clips_by_dask.py", out, "-k", "3",
                "--clips", *sorted(self.takes.glob("*.npy")), "--targets", *self.targets]
        done = subprocess.run(line, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_expected(out)
        # Again, with one output that is missing and a clip that is damaged.
        (out / "a_head.npy").unlink()
        (self.takes / "c.npy").write_bytes(b"no array")
        again = subprocess.run([*line[:6], self.takes / "c.npy", *line[6:]], capture_output=True,
                               text=True)
        (self.takes / "c.npy").unlink()
        self.assertEqual(again.returncode, 1, again.stdout)
        self.assertIn("6 pairs, 3 of them done", again.stdout)
        self.assertIn("c.npy", again.stderr)
        self.assert_expected(out)

    def test_as_an_array_of_jobs(self):
        out = self.path / "slurm"
        for pair in range(5):
            subprocess.run([CLUSTER / "clips.slurm"], check=True, env={
                **os.environ, "CLIPS": f"{self.takes}/*.npy", "TARGETS": " ".join(self.targets),
                "OUT": str(out), "K": "3", "SLURM_ARRAY_TASK_ID": str(pair)})
        self.assert_expected(out)

    def test_of_jobs_with_all_memory_and_clips_of_one_name(self):
        job = {**os.environ, "CLIPS": f"{self.takes}/a.npy", "TARGETS": str(self.head), "K": "3",
               "OUT": str(self.path / "whole"), "SLURM_ARRAY_TASK_ID": "0",
               "SLURM_MEM_PER_NODE": "0"}
        subprocess.run([CLUSTER / "clips.slurm"], check=True, env=job)
        self.assertTrue((self.path / "whole" / "a_head.npy").exists())
        more = self.path / "more"
        more.mkdir()
        (more / "a.obj").write_bytes(b"")
        job["OUT"] = str(self.path / "both")
        for changed in ({"CLIPS": f"{self.takes}/a.npy {more}/*.obj"},
                        {"TARGETS": f"{self.head} {more}/head"}):
            refused = subprocess.run([CLUSTER / "clips.slurm"], env=job | changed,
                                     capture_output=True, text=True)
            self.assertEqual(refused.returncode, 2)
            self.assertIn("have one name", refused.stderr)
            self.assertFalse((self.path / "both").exists())


if __name__ == "__main__":
    unittest.main()
