"""The command on several processes of mpirun: the same bytes as on one, and no output of a run that
one of them cannot finish.

usage: ranks_test.py MIMETRA"""

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MIMETRA = pathlib.Path(sys.argv.pop(1)).resolve()
# As many as there are, whatever the machine has, and by whoever runs the tests.
MPIRUN = ["mpirun", "--oversubscribe", "--allow-run-as-root"]


class Ranks(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self._folder.name)
        self.run_on(1, "sample", "-o", "sample")
        self.run_on(1, "convert", "sample", "--weights", "sample/performance.csv",
                    "-o", "take.npy")

    def tearDown(self):
        self._folder.cleanup()

    def make_long_take(self):
        """The performance ten times, ever weaker: its motion is much larger than the program, of which
        one run holds a few MB more than another."""
        with open(self.folder / "sample/performance.csv", newline="") as file:
            names, *rows = csv.reader(file)
        with open(self.folder / "long.csv", "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(names)
            for i in range(10):
                for time_, *weights in rows:
                    writer.writerow([float(time_) + 4 * i,
                                     *(0.95 ** i * float(weight) for weight in weights)])
        self.run_on(1, "convert", "sample", "--weights", "long.csv", "-o", "long.npy")

    def plan(self, ranks, *arguments):
        return json.loads(self.run_on(ranks, *arguments, "--dry-run", "--json").stdout)

    def command(self, ranks, *arguments):
        return [*MPIRUN, "-n", str(ranks), str(MIMETRA), *arguments]

    def start(self, ranks, *arguments):
        return subprocess.Popen(self.command(ranks, *arguments), cwd=self.folder, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def run_on(self, ranks, *arguments, code=0):
        result = subprocess.run(self.command(ranks, *arguments), cwd=self.folder, text=True,
                                capture_output=True, timeout=300)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def names(self):
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*"))

    def test_components_are_the_same_bytes_on_any_number_of_ranks(self):
        self.run_on(1, "decompose", "take.npy", "-k", "8", "-o", "one.h5")
        for ranks in (2, 3, 4):
            name = f"{ranks}.h5"
            self.run_on(ranks, "decompose", "take.npy", "-k", "8", "-o", name)
            self.assertEqual(self.bytes_of(name), self.bytes_of("one.h5"), name)

    def test_components_do_not_depend_on_the_memory_of_ranks(self):
        self.make_long_take()
        command = ["decompose", "long.npy", "-k", "8", "--iterations", "5"]
        self.run_on(1, *command, "-o", "one.h5")
        whole = self.plan(2, *command, "-o", "two.h5")
        self.assertEqual(whole["scratch_bytes"], 0)
        less = ["--memory", str(int(0.75 * whole["memory_bytes"]))]
        self.assertGreater(self.plan(2, *command, *less, "-o", "two.h5")["scratch_bytes"], 0)
        self.run_on(2, *command, *less, "-o", "two.h5")
        self.assertEqual(self.bytes_of("two.h5"), self.bytes_of("one.h5"))

    def test_regions_are_the_same_bytes_on_any_number_of_ranks(self):
        self.run_on(1, "regions", "take.npy", "-k", "8", "-o", "one.json")
        self.run_on(3, "regions", "take.npy", "-k", "8", "-o", "three.json")
        self.assertEqual(self.bytes_of("three.json"), self.bytes_of("one.json"))

    def test_transfers_are_the_same_bytes_on_any_number_of_ranks(self):
        for options in (["-k", "4"], ["--full", "--space", "vertex"], ["-k", "4", "--per-region"]):
            said, files = [], []
            for ranks in (1, 2, 3):
                result = self.run_on(ranks, "transfer", "take.npy", "sample", "sample@identity000=1",
                                     *options, "-o", f"on{ranks}", "--force", "--json")
                report = json.loads(result.stdout)
                said.append([[target[key] for key in ("de_all", "leak", "flipped", "missed")]
                             for target in report["targets"]])
                files.append({path.relative_to(self.folder / f"on{ranks}"): path.read_bytes()
                              for path in (self.folder / f"on{ranks}").rglob("*.ply")})
            self.assertGreater(len(files[0]), 2 * 100, "frames of two targets")
            self.assertTrue(files[0] == files[1] == files[2], options)
            self.assertEqual(said[1:], said[:1] * 2)

    def test_other_operations_are_those_of_one_rank(self):
        self.run_on(1, "convert", "take.npy", "-o", "frames/")
        for ranks in (1, 2, 3):
            self.run_on(ranks, "convert", "frames", "-o", f"again{ranks}.npy")
            self.assertEqual(self.bytes_of(f"again{ranks}.npy"), self.bytes_of("again1.npy"))
        self.run_on(1, "align", "frames", "-o", "still1.npy")
        self.run_on(3, "align", "frames", "-o", "still3.npy")
        self.assertEqual(self.bytes_of("still3.npy"), self.bytes_of("still1.npy"))
        rows = []
        for ranks in (1, 3):
            said = self.run_on(ranks, "evaluate", "frames", "sample", "-k", "3,6", "--json").stdout
            rows.append([[row[key] for key in ("k", "de_all", "de_region", "leak")]
                         for row in json.loads(said)["rows"]])
        self.assertEqual(rows[1], rows[0])

    def test_options_of_what_is_written_are_those_of_one_rank(self):
        for options in (["convert", "take.npy", "--single", "-o", "{}.npy"],
                        ["regions", "take.npy", "-k", "4", "-o", "{}.pvd", "--paraview", "{}.py",
                         "--up", "z"],
                        ["transfer", "take.npy", "sample", "-k", "4", "--weights-out", "{}.csv",
                         "--format", "off", "-o", "{}/"]):
            for name, ranks in (("one", 1), ("two", 2)):
                self.run_on(ranks, *[option.format(name) for option in options])
        self.assertEqual(self.bytes_of("two.npy"), self.bytes_of("one.npy"))
        self.assertEqual(self.bytes_of("two.csv"), self.bytes_of("one.csv"))
        self.assertEqual(self.bytes_of("two.py").replace(b"two", b"one"),
                         self.bytes_of("one.py"))
        self.assertEqual(self.bytes_of("two/frame_0007.off"), self.bytes_of("one/frame_0007.off"))

    def test_a_broken_frame_ends_the_run_with_one_message(self):
        self.run_on(1, "convert", "take.npy", "-o", "frames/")
        broken = sorted((self.folder / "frames").glob("*.ply"))[7]
        broken.write_bytes(broken.read_bytes()[:-20])
        before = self.names()
        result = self.run_on(3, "convert", "frames", "-o", "again.npy", code=3)
        self.assertEqual(result.stderr.count(broken.name), 1, result.stderr)
        self.assertEqual(self.names(), before)

    def test_the_first_rank_alone_prints(self):
        result = self.run_on(3, "decompose", "take.npy", "-k", "4", "-o", "c.h5", "--json")
        self.assertEqual(json.loads(result.stdout)["components"], 4)
        self.assertEqual(self.run_on(3, "--version").stdout.count("mimetra"), 1)

    def test_what_all_find_wrong_the_first_says(self):
        before = self.names()
        result = self.run_on(3, "decompose", "missing.npy", "-k", "4", "-o", "c.h5", code=3)
        self.assertEqual(result.stderr.count("missing.npy"), 1, result.stderr)
        result = self.run_on(3, "decompose", "take.npy", "-k", "0", "-o", "c.h5", code=2)
        self.assertEqual(result.stderr.count("-k: expected"), 1, result.stderr)
        self.assertEqual(self.names(), before)

    def end_of_run(self, rank, before_it, *arguments, code):
        """What the command on two processes, one of them in another state, says that has failed, in
        time, and left nothing behind."""
        names = self.names()
        script = self.folder / "elsewhere.sh"
        script.write_text(f'#!/bin/sh\n[ "$OMPI_COMM_WORLD_RANK" = {rank} ] && {{ {before_it}; }}\n'
                          f'exec "{MIMETRA}" "$@"\n')
        script.chmod(0o755)
        started = time.monotonic()
        result = subprocess.run([*MPIRUN, "-n", "2", str(script), *arguments], cwd=self.folder,
                                text=True, capture_output=True, timeout=60)
        script.unlink()
        self.assertLess(time.monotonic() - started, 10)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(self.names(), names)
        return result.stderr

    def test_a_rank_without_the_input_ends_the_run(self):
        said = self.end_of_run(1, f'cd "{tempfile.gettempdir()}"', "decompose", "take.npy", "-k", "4",
                               "-o", "c.h5", code=3)
        self.assertIn("take.npy", said)
        # Reads for itself what the first writes: without the others nothing stands.
        for name in ("c.npy", "c/"):
            said = self.end_of_run(1, "cd /", "convert", "take.npy", "-o", name, code=3)
            self.assertIn("take.npy", said)

    def test_a_rank_with_another_input_ends_the_run(self):
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        # As many frames and vertices, of another head.
        self.run_on(1, "convert", "sample@identity001=1", "--weights", "sample/performance.csv",
                    "-o", "elsewhere/take.npy")
        for operation in (["decompose", "take.npy", "-k", "4", "-o", "c.h5"],
                          ["convert", "take.npy", "-o", "c/"]):
            said = self.end_of_run(1, f'cd "{elsewhere}"', *operation, code=4)
            self.assertIn("process 1 reads another content than process 0", said)

    def test_the_plan_is_that_of_one_of_the_ranks(self):
        self.make_long_take()
        plans = [self.plan(ranks, "decompose", "long.npy", "-k", "8", "-o", "c.h5")
                 for ranks in (1, 2, 3)]
        self.assertEqual([plan["processes"] for plan in plans], [1, 2, 3])
        memory = [plan["memory_bytes"] for plan in plans]
        self.assertEqual(memory, sorted(memory, reverse=True))

    def test_a_rank_with_a_full_disk_ends_the_run(self):
        # Files end at 64 KB, with the error of a disk that is full.
        full = "trap '' XFSZ; ulimit -f 128"
        said = self.end_of_run(0, full, "decompose", "take.npy", "-k", "4", "-o", "c.h5", code=5)
        self.assertIn("c.h5", said)
        self.make_long_take()
        command = ["decompose", "long.npy", "-k", "4", "-o", "c.h5"]
        less = ["--memory", str(int(0.75 * self.plan(2, *command)["memory_bytes"]))]
        self.assertGreater(self.plan(2, *command, *less)["scratch_bytes"], 0)
        self.assertIn("TMPDIR", self.end_of_run(1, full, *command, *less, code=5))

    def test_a_rank_that_is_killed_ends_the_run(self):
        before = self.names()
        process = self.start(3, "decompose", "take.npy", "-k", "30", "--iterations", "100000",
                             "--tolerance", "0", "-o", "c.h5")
        victim = None
        while victim is None:
            time.sleep(0.5)
            self.assertIsNone(process.poll())
            found = subprocess.run(["pgrep", "-f", "iterations 100000 --tolerance 0"], text=True,
                                   capture_output=True).stdout.split()
            own = [int(pid) for pid in found
                   if os.path.exists(f"/proc/{pid}/exe")
                   and os.path.realpath(f"/proc/{pid}/exe") == str(MIMETRA)]
            victim = own[-1] if len(own) == 3 else None
        time.sleep(1)
        os.kill(victim, signal.SIGKILL)
        started = time.monotonic()
        process.communicate(timeout=60)
        self.assertLess(time.monotonic() - started, 10)
        self.assertNotEqual(process.returncode, 0)
        self.assertEqual(self.names(), before)


if __name__ == "__main__":
    unittest.main(verbosity=2)
