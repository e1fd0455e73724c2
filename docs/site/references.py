"""Pages that are made of other things than documents: headers, the table of operations, samples."""

import ast
import keyword
import pathlib
import re

from pages import anchor_of_sample, page_of_header

TYPES = {"flag": "bool", "integer": "int", "integer list": "Iterable[int]", "number": "float",
         "length": "float | str", "text": "str", "file": "str | PathLike", "choice": "str"}
# What _operations.py reserves.
RESERVED = {"report", "summary", "manifest", "force"}


def public_headers(root):
    """Headers that are installed: those under HEADERS in the lists of the folders."""
    headers = []
    for folder in ("geodesic", "toolkit", "fitting", "plugins/c", "samples/head"):
        for path in sorted((root / folder).rglob("CMakeLists.txt")):
            for block in re.findall(r"\bHEADERS\s+((?:[\w.]+\.h\s*)+)", path.read_text()):
                headers += [path.parent.relative_to(root) / name for name in sorted(block.split())]
    return headers


def of_folders(headers):
    folders = {}
    for path in headers:
        folders.setdefault(str(path.parent), []).append(path)
    return folders


def main_page_of_cpp(headers):
    """The first page of Doxygen's."""
    lines = ["# C++ and C reference", "",
             "The public headers by folder; each folder is a library. An installation has them below",
             "`mimetra/`. The C interface is mimetra.h.", ""]
    for folder, paths in of_folders(headers).items():
        lines += [f"- **{folder}**: " + ", ".join(path.name for path in paths)]
    return "\n".join(lines) + "\n"


def cpp_page(root, headers):
    """The page that leads there."""
    lines = ["# C++ and C", "",
             "The public headers; each folder is a library of its own. An include names the path:",
             "`#include <mimetra/toolkit/mesh/mesh_sequence.h>` of an installation. A header's comment says what is",
             "computed, shapes, units, errors and the source. All classes and functions are also in",
             '<a class="reference" href="cpp/index.html">one reference</a> with a search of its own.', "",
             "[As a library](readme.md#as-a-library) shows the first lines of a program, [Samples](samples.md) whole ones.",
             ""]
    for folder, paths in of_folders(headers).items():
        lines += [f"## {folder}", "", "| header | declares |", "| --- | --- |"]
        for path in paths:
            lines.append(f'| <a class="reference" href="cpp/{page_of_header(path)}">{path.name}</a> '
                         f"| {declared(root / path)} |")
        lines.append("")
    return "\n".join(lines)


def declared(path):
    """Names of types and functions on the outermost level of a header."""
    names = []
    for line in path.read_text().splitlines():
        found = (re.match(r"(?:class|struct|enum class) (\w+)(?! *;)", line)
                 or re.match(r"(?!using |typedef |template|return )\w[\w:<>,&* ]*[ &*>](\w+)\(",
                             line))
        if found and not line.rstrip().endswith(f"{found.group(1)};") and found.group(1) not in names:
            names.append(found.group(1))
    return ", ".join(f"`{name}`" for name in names) or "-"


def samples_page(root):
    """Sources of the samples."""
    lines = ["# Samples", "", "Programs of one file on the built-in head, [plugins](plugins.md), and scripts. An installation",
             "has the programs as a project of its own, in `share/doc/mimetra/samples`.", ""]
    languages = {".cpp": "cpp", ".c": "c", ".py": "python", ".sh": "sh", ".slurm": "sh", ".txt": "cmake"}
    plugin = root / "samples" / "plugin"
    programs = sorted((root / "samples").glob("*.cpp"))
    for title, paths in (
            ("Programs", programs), ("samples/plugin", sorted(plugin.iterdir())),
            ("samples/cluster", sorted((root / "samples" / "cluster").iterdir())),
            ("Scripts", sorted((root / "samples").glob("*.sh")))):
        lines += [f'<span id="{anchor_of_sample(title)}"></span>', "", f"({anchor_of_sample(title)})=",
                  f"## {title}", ""]
        for path in paths:
            if path.suffix not in languages:
                continue
            name = path.relative_to(root)
            lines += [f"({anchor_of_sample(name)})=", f"### {name}", "",
                      f"````{languages[path.suffix]}", path.read_text().rstrip(), "````", ""]
    return "\n".join(lines)


def python_name(name):
    made = name.replace("-", "_")
    return made + "_" if keyword.iskeyword(made) or made in RESERVED else made


def in_python(root):
    """Operations that the table of hosts says Python has."""
    table = (root / "docs" / "plugins.md").read_text()
    rows = [[cell.strip() for cell in line.strip("| ").split("|")]
            for line in table.splitlines() if line.startswith("| ")]
    column = next(row for row in rows if row[0] == "operation").index("Python")
    return [row[0].strip("`") for row in rows if row[0].startswith("`") and len(row) > column
            and row[column] == "yes"]


def python_page(root, table):
    """The functions of the module, of the table of operations, and its values, of their docstrings."""
    lines = ["# Python", "",
             "The module `mimetra` has one function for each operation, with the command's parameters, on NumPy arrays.",
             "[In Python](readme.md#in-python) shows its use. `help(mimetra.transfer)` prints what this page says, also of",
             "operations of [plugins](plugins.md). Every function also takes `force`, `manifest`, `progress` and `threads`,",
             "and returns a `Result` with its outputs, `report` (a dict) and `summary` (text).", "", "## Values", ""]
    lines += values(root / "plugins/python/mimetra/_data.py", "Data")
    lines += ["## Errors", ""] + values(root / "plugins/python/mimetra/_errors.py", "Error")
    lines += ["## Functions", ""]
    known = in_python(root)
    for operation in table:
        if operation["name"] in known:
            lines += function(operation)
    return "\n".join(lines)


def values(path, base):
    """Classes of a module with their docstrings."""
    lines = []
    for node in ast.parse(path.read_text()).body:
        if not isinstance(node, ast.ClassDef) or node.name.startswith("_"):
            continue
        bases = [each.id for each in node.bases if isinstance(each, ast.Name)]
        text = ast.get_docstring(node)
        if not text or node.name != base and base not in bases:
            continue
        made = next((each for each in node.body if isinstance(each, ast.FunctionDef)
                     and each.name == "__init__"), None)
        shown = f"{node.name}({ast.unparse(made.args).removeprefix('self').lstrip(', ')})" if made else node.name
        lines += [f"### {node.name}", "", "```python", f"mimetra.{shown}", "```", "",
                  re.sub(r"(?<!`)`([^`]+)`(?!`)", r"`\1`", text), ""]
    return lines


def function(operation):
    """One function: its call, and what it takes."""
    inputs = operation.get("inputs", [])
    outputs = [each for each in operation.get("outputs", []) if each["kind"] != "document"]
    first = [python_name(each["name"]) for each in inputs if not each["optional"] and not each["named"]]
    name = python_name(operation["name"])
    lines = [f"### {name}", "", operation["summary"] + ".", "", "```python",
             f"mimetra.{name}({', '.join([*first, '*', '...'])})", "```", "",
             "| argument | type | default | |", "| --- | --- | --- | --- |"]
    for each in inputs:
        kind = each["kind"] + (", or a list of them" if each["repeated"] else "")
        lines.append(row(each["name"], kind, "None" if each["optional"] else "", each["help"]))
    for each in operation.get("parameters", []):
        lines.append(row(each["name"], TYPES[each["kind"]], shown(each), each["help"] + notes(each)))
    for each in outputs:
        lines.append(row(each["name"], "bool or path", str(not each["optional"]),
                         "makes it, or writes it: " + each["help"]))
    return [*lines, ""]


def row(name, kind, default, text):
    cells = [f"`{python_name(name)}`", kind, f"`{default}`" if default else "", text]
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def shown(parameter):
    default = parameter["default"]
    if isinstance(default, list):
        return repr(tuple(default))
    return repr(default)


def notes(parameter):
    """Choices, range and unit."""
    texts = []
    if parameter.get("choices"):
        texts.append("one of " + ", ".join(f"`{each}`" for each in parameter["choices"]))
    low, high = parameter.get("minimum"), parameter.get("maximum")
    if low is not None and high is not None:
        texts.append(f"{low:g} to {high:g}")
    elif low is not None:
        texts.append(f"at least {low:g}")
    elif high is not None:
        texts.append(f"at most {high:g}")
    if parameter.get("unit"):
        texts.append(f"[{parameter['unit']}]")
    return "".join("; " + text for text in texts)
