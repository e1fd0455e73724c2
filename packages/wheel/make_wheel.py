"""Makes a wheel of installations of mimetra: the Python module, libmimetra_c and what it needs.

    make_wheel.py BASELINE V3 FOLDER

BASELINE and V3 are installations (a prefix) for any x86-64 and for x86-64-v3. The wheel holds no
extension module, so it serves every Python with ctypes. glibc, libstdc++ and libgcc are the
system's; of everything else the wheel has copies, with names that no other library has.
"""

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile

_OF_THE_SYSTEM = re.compile(r"(ld-linux.*|libc|libm|libpthread|libdl|librt|libstdc\+\+|libgcc_s)\.so\.\d+")
_V3 = "glibc-hwcaps/x86-64-v3"  # where glibc 2.33 and later look first, on such a processor

_METADATA = """\
Metadata-Version: 2.1
Name: mimetra
Version: {version}
Summary: Region-based deformation transfer for mesh sequences
License: GPL-3.0-or-later
Requires-Python: >=3.9
Requires-Dist: numpy
Description-Content-Type: text/markdown

The operations of mimetra on NumPy arrays: `import mimetra; help(mimetra)`.

The module finds the regions of an animated face that move, and transfers their deformation to
another character. Faces in pictures need a predictor of 68 landmarks (`face_model=`), videos the
libraries of FFmpeg 5.
"""

_WHEEL = """\
Wheel-Version: 1.0
Generator: mimetra
Root-Is-Purelib: false
Tag: {tag}
"""


def _said(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def _needed(library):
    """The libraries that one needs, by name, and theirs: {name: path}."""
    found = re.findall(r"^\s*(\S+) => (/\S+)", _said("ldd", str(library)), re.MULTILINE)
    return {name: pathlib.Path(path).resolve() for name, path in found
            if not _OF_THE_SYSTEM.fullmatch(name)}


def _direct(library):
    return _said("patchelf", "--print-needed", str(library)).split()


def _own_name(name, path):
    """A name that no other library of a process has: it would be taken for the same."""
    stem, _, rest = name.partition(".so")
    return f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so{rest}"


def _relink(library, soname, names, runpath):
    replaced = [option for name in _direct(library) if name in names
                for option in ("--replace-needed", name, names[name])]
    # One after the other: of several changes at once patchelf 0.14 loses some.
    for options in (["--set-soname", soname], ["--set-rpath", runpath], replaced):
        if options:
            subprocess.run(["patchelf", *options, str(library)], check=True)


def _copyright(path):
    """The licence of a library of a Debian package: (package, file)."""
    candidates = [path, pathlib.Path(str(path).replace("/usr/lib/", "/lib/", 1))]
    for candidate in candidates:
        done = subprocess.run(["dpkg-query", "-S", str(candidate)], capture_output=True, text=True)
        if done.returncode == 0:
            package = done.stdout.split(":")[0]
            return package, pathlib.Path("/usr/share/doc", package, "copyright")
    raise SystemExit(f"make_wheel: {path}: is of no package, its licence is not known")


def _compiled_in():
    """Whose headers were compiled into the library, with their licences; pages are the command's."""
    text = pathlib.Path(__file__).parent.parent.joinpath("copyright.in").read_text()
    return "\n\n".join(part for part in text.rstrip().split("\n\n") if "viewer" not in part) + "\n"


def _newest_glibc(libraries):
    """The least glibc that serves them all: 2.36."""
    versions = {tuple(map(int, version.split("."))) for library in libraries
                for version in re.findall(r"GLIBC_([\d.]+)", _said("readelf", "-V", str(library)))}
    return max(versions)


def _library_of(prefix):
    return next(pathlib.Path(prefix).glob("lib/**/libmimetra_c.so.1"))


def _lay_out(baseline, v3, folder):
    """Copies the module and its libraries; returns those that were not built here."""
    module = folder / "mimetra"
    shutil.copytree(pathlib.Path(baseline, "lib/python3/dist-packages/mimetra"), module,
                    ignore=shutil.ignore_patterns("__pycache__"))
    libraries = module / "libraries"
    (libraries / _V3).mkdir(parents=True)
    builds = {"": _library_of(baseline), _V3: _library_of(v3)}

    needed = _needed(builds[""])
    names = {name: _own_name(name, path) for name, path in needed.items()}
    for name, path in needed.items():
        copy = libraries / names[name]
        shutil.copyfile(path, copy)
        _relink(copy, names[name], names, "$ORIGIN")

    own = _own_name("libmimetra_c.so.1", builds[""])
    for place, library in builds.items():
        shutil.copyfile(library, libraries / place / own)
        _relink(libraries / place / own, own, names, "$ORIGIN/../.." if place else "$ORIGIN")
    # The module opens a library by its path. That one holds nothing but that it needs the other,
    # of which the loader takes the build for the processor.
    source = pathlib.Path(__file__).parent.parent / "debian/any_instructions.c"
    subprocess.run(["cc", "-shared", "-fPIC", "-s", "-o", str(module / "libmimetra_c.so"), str(source),
                    "-Wl,-soname,libmimetra_c.so", "-Wl,--no-as-needed", str(libraries / own),
                    "-Wl,--allow-shlib-undefined"], check=True)
    subprocess.run(["patchelf", "--set-rpath", "$ORIGIN/libraries", str(module / "libmimetra_c.so")],
                   check=True)
    return needed.values()


def _hash(data):
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("=")


def _pack(folder, info, wheel):
    """A zip with the list of what it holds; the same bytes for the same files."""
    made = time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", time.time())))[:6]
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as packed:
        def add(name, data):
            entry = zipfile.ZipInfo(name, made)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o100644 << 16
            packed.writestr(entry, data)
        for file in sorted(each for each in folder.rglob("*") if each.is_file()):
            name, data = str(file.relative_to(folder)), file.read_bytes()
            add(name, data)
            record.append(f"{name},{_hash(data)},{len(data)}\n")
        add(f"{info}/RECORD", "".join([*record, f"{info}/RECORD,,\n"]))


def main(baseline, v3, output):
    version = re.search(r"^Version: (.*)$", next(
        pathlib.Path(baseline).glob("lib/**/pkgconfig/mimetra_c.pc")).read_text(), re.MULTILINE)[1]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        copied = _lay_out(baseline, v3, folder)
        glibc = _newest_glibc(folder.rglob("*.so*"))
        tag = f"py3-none-manylinux_{glibc[0]}_{glibc[1]}_{os.uname().machine}"

        info = folder / f"mimetra-{version}.dist-info"
        licenses = info / "licenses"
        licenses.mkdir(parents=True)
        (info / "METADATA").write_text(_METADATA.format(version=version))
        (info / "WHEEL").write_text(_WHEEL.format(tag=tag))
        shutil.copyfile(pathlib.Path(baseline, "share/doc/mimetra/LICENSE"), licenses / "LICENSE")
        (licenses / "copyright").write_text(_compiled_in())
        for package, file in sorted({_copyright(path) for path in copied}):
            shutil.copyfile(file, licenses / f"{package}.copyright")

        wheel = pathlib.Path(output, f"mimetra-{version}-{tag}.whl")
        wheel.parent.mkdir(parents=True, exist_ok=True)
        _pack(folder, info.name, wheel)
        print(wheel)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
