"""Prints the size of the project by folder: files, headers, lines, and types in installed headers.

usage: size.py ROOT
"""

import pathlib
import re
import sys

SUFFIXES = {".cpp", ".h", ".c", ".py", ".js", ".mjs", ".sh"}
LIBRARIES = {"geodesic", "toolkit", "fitting", "samples", "plugins"}
# A definition outside of other types; a forward declaration has a semicolon before any brace.
TYPE = re.compile(r"^(?:typedef )?(?:class|struct|enum class|enum) [^;{}]*{", re.MULTILINE)


def folder_of(file):
    """The library of a file: toolkit/mesh, plugins/c, tests/io, geodesic."""
    parts = file.parts[:-1]
    depth = 2 if parts[:1] and parts[0] in ("toolkit", "plugins", "tests", "samples") else 1
    return "/".join(parts[:depth]) or "(root)"


def is_installed(root, header):
    """Whether the CMakeLists.txt beside a header lists it under HEADERS."""
    lists = root / header.parent / "CMakeLists.txt"
    if not lists.exists():
        return False
    blocks = re.findall(r"\bHEADERS\b([^()]*)", lists.read_text())
    return any(header.name in block.split() for block in blocks)


def measure(root):
    """{folder: [files, headers, lines, public types]}."""
    sizes = {}
    for path in sorted(root.rglob("*")):
        file = path.relative_to(root)
        if file.parts[0] in ("build", "out", ".git") or "node_modules" in file.parts:
            continue
        if file.suffix not in SUFFIXES and file.name != "dev":
            continue
        text = path.read_text()
        size = sizes.setdefault(folder_of(file), [0, 0, 0, 0])
        size[0] += 1
        size[1] += file.suffix == ".h"
        size[2] += text.count("\n")
        if file.suffix == ".h" and file.parts[0] in LIBRARIES and is_installed(root, file):
            size[3] += len(TYPE.findall(text))
    return sizes


def main():
    sizes = measure(pathlib.Path(sys.argv[1]))
    row = "{:28}{:>8}{:>9}{:>9}{:>14}"
    for title, is_test in (("code", False), ("tests", True)):
        folders = {name: size for name, size in sizes.items() if name.startswith("tests") == is_test}
        print(row.format(title, "files", "headers", "lines", "public types"))
        for name, size in folders.items():
            print(row.format(name, *size))
        print(row.format("in all", *map(sum, zip(*folders.values()))))
        print()


main()
