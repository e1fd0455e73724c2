"""Installs a wheel into new virtual environments, without a network, and uses it there.

    wheel_test.py WHEEL [FOLDER]

CPython has the system's NumPy. PyPy takes one of the wheels in FOLDER; without one it is only seen
that the library can be loaded and serves its table.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

WHEEL, NUMPY = "", ""

# What of the system the library may use.
ALLOWED = ("ld-linux-x86-64", "libc.so", "libm.so", "libstdc++", "libgcc_s", "libpthread", "libdl")

MAPPED = """
import re
mapped = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
own = [each for each in mapped if "/mimetra/" in each]
print(*own, sep="\\n")
"""

RUN = """
import hashlib
import mimetra
import numpy as np
head = mimetra.sample().out
poses = head.neutral + np.tensordot(head.weights[:20], head.expressions, 1)
take = mimetra.Sequence(poses, head.faces, head.times[:20], rest=head.neutral)
actor = mimetra.Model(head.neutral + head.identities[1], head.faces, head.expressions,
                      head.expression_names)
result = mimetra.transfer(take, actor, k=5, weights_out=True)
mimetra.Sequence.save(result.out, "moved.npy", force=True)
print(mimetra.__version__, *("%.6f" % each for each in result.weights_out["jawOpen"]))
"""

# What needs no NumPy.
LOAD = """
import ctypes, pathlib, sys
library = ctypes.CDLL(next(pathlib.Path(sys.prefix).glob("**/mimetra/libmimetra_c.so")).as_posix())
library.mimetra_get_interface.restype = ctypes.c_void_p
assert library.mimetra_get_interface(1)
"""


def has_v3():
    flags = pathlib.Path("/proc/cpuinfo").read_text().split()
    return {"avx2", "fma", "bmi1", "bmi2", "movbe", "f16c", "abm"} <= set(flags)


class Environment:
    """A new virtual environment with the wheel."""

    def __init__(self, python, folder, *options, packages=()):
        self.folder = pathlib.Path(folder)
        subprocess.run([python, "-m", "venv", *options, str(self.folder)], check=True)
        self.python = str(self.folder / "bin/python")
        for package in [WHEEL, *packages]:
            subprocess.run([self.python, "-m", "pip", "-q", "--disable-pip-version-check", "install",
                            "--no-index", "--no-deps", package], check=True)
        self.libraries = next(self.folder.glob("lib/**/mimetra/libraries"))

    def said(self, program, **variables):
        kept = {name: value for name, value in os.environ.items()
                if not name.startswith(("PYTHON", "MIMETRA", "LD_"))}
        return subprocess.run([self.python, "-c", program], check=True, capture_output=True, text=True,
                              cwd=self.folder, env={**kept, **variables}).stdout


class Wheel(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def check(self, environment, program):
        """The program runs, on the build for this processor, and loads nothing of others."""
        said = environment.said(program + MAPPED).splitlines()
        build = [line for line in said if "libmimetra_c-" in line]
        self.assertEqual(len(build), 1, said)
        self.assertEqual("glibc-hwcaps" in build[0], has_v3(), build)
        return said[0]

    def check_needed(self, environment):
        own = [each for each in environment.libraries.parent.rglob("*.so*")]
        self.assertGreater(len(own), 5)
        for library in own:
            listed = subprocess.run(["ldd", str(library)], check=True, capture_output=True, text=True)
            for line in listed.stdout.splitlines():
                name = line.split()[0].rsplit("/", 1)[-1]
                if name.startswith(ALLOWED) or name.startswith("linux-vdso"):
                    continue
                self.assertIn(f"{environment.libraries}/", line.replace("/glibc-hwcaps/x86-64-v3/../..", ""),
                              f"{library} needs {line}")

    def test_serves_cpython(self):
        environment = Environment("/usr/bin/python3", self.folder, "--system-site-packages")
        self.check_needed(environment)
        chosen = self.check(environment, RUN)
        baseline = next(environment.libraries.glob("libmimetra_c-*"))
        self.assertEqual(environment.said(RUN, MIMETRA_LIBRARY=str(baseline)).splitlines()[0], chosen)

    @unittest.skipUnless(shutil.which("pypy3"), "without pypy3")
    def test_serves_pypy(self):
        packages = [str(each) for each in pathlib.Path(NUMPY).glob("numpy-*pypy*.whl")] if NUMPY else []
        environment = Environment("pypy3", self.folder, packages=packages)
        self.check(environment, RUN if packages else LOAD)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    WHEEL, *rest = sys.argv[1:]
    WHEEL, NUMPY = os.path.abspath(WHEEL), rest[0] if rest else ""
    unittest.main(argv=sys.argv[:1])
