"""Pages about headers, operations and samples, made without a document."""

import ast
import keyword
import re

from pages import anchor_of_sample, page_of_header

CPP = """# C++ and C

The public headers; each folder is a separate library. Include a header by its path in an
installation: `#include <mimetra/toolkit/mesh/mesh_sequence.h>`. A header's comment explains what it
computes, shapes, units, errors and the source. All classes and functions are also in
<a class="reference" href="cpp/index.html">one reference</a> with a search of its own.

`#include <mimetra/all.h>` includes the headers of values, algorithms and files.

[As a library](readme.md#as-a-library) shows a first program, and [Samples](samples.md) show more.
"""

CPP_MAIN = """# C++ and C reference

The public headers by folder; each folder is a library. An installation has them below `mimetra/`.
The C interface is mimetra.h.
"""

SAMPLES = """# Samples

One-file programs on the built-in head, [plugins](plugins.md), and scripts. An installation has the
programs as a separate project in `share/doc/mimetra/samples`.
"""

PYTHON = """# Python

The module `mimetra` has one function for each operation, with the command's parameters, on NumPy
arrays. [In Python](readme.md#in-python) shows its use. `help(mimetra.transfer)` prints the text
of this page, also for operations of [plugins](plugins.md). Every function also takes `force`,
`manifest`, `progress` and `threads`. It returns a `Result` with its outputs, `report` (a dict)
and `summary` (text).
"""

TYPES = {"flag": "bool", "integer": "int", "integer list": "Iterable[int]", "number": "float",
         "length": "float | str", "text": "str", "file": "str | PathLike", "choice": "str"}
# Names that _operations.py reserves.
RESERVED = {"report", "summary", "manifest", "force"}
LANGUAGES = {".cpp": "cpp", ".c": "c", ".py": "python", ".sh": "sh", ".slurm": "sh",
             ".txt": "cmake"}


def public_headers(root):
    """Installed headers: the entries of HEADERS in the CMakeLists.txt of each folder."""
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
    """The first page of Doxygen's reference."""
    lines = [f"- **{folder}**: " + ", ".join(path.name for path in paths)
             for folder, paths in of_folders(headers).items()]
    return CPP_MAIN + "\n" + "\n".join(lines) + "\n"


def cpp_page(root, headers):
    """The page that links to Doxygen's pages."""
    lines = [CPP]
    for folder, paths in of_folders(headers).items():
        lines += [f"## {folder}", "", "| header | declares |", "| --- | --- |"]
        for path in paths:
            link = f'<a class="reference" href="cpp/{page_of_header(path)}">{path.name}</a>'
            lines.append(f"| {link} | {declared(root / path)} |")
        lines.append("")
    return "\n".join(lines)


def declared(path):
    """Names of types and functions on the outermost level of a header."""
    of_type = re.compile(r"(?:class|struct|enum class) (\w+)(?! *;)\b(?!;)")
    of_function = re.compile(r"(?!using |typedef |template|return )\w[\w:<>,&* ]*[ &*>](\w+)\(")
    names = []
    for line in path.read_text().splitlines():
        found = of_type.match(line) or of_function.match(line)
        if found and found.group(1) not in names:
            names.append(found.group(1))
    return ", ".join(f"`{name}`" for name in names) or "-"


def samples_page(root):
    """The page of the samples' sources."""
    samples = root / "samples"
    groups = {"Programs": samples.glob("*.cpp"), "samples/plugin": (samples / "plugin").iterdir(),
              "samples/cluster": (samples / "cluster").iterdir(),
              "Scripts": samples.glob("*.sh")}
    lines = [SAMPLES]
    for title, paths in groups.items():
        lines += [f"({anchor_of_sample(title)})=", f"## {title}", ""]
        for path in sorted(paths):
            if path.suffix not in LANGUAGES:
                continue
            name = path.relative_to(root)
            lines += [f"({anchor_of_sample(name)})=", f"### {name}", "",
                      f"````{LANGUAGES[path.suffix]}", path.read_text().rstrip(), "````", ""]
    return "\n".join(lines)


def function_name(name):
    made = name.replace("-", "_")
    return made + "_" if keyword.iskeyword(made) else made


def python_name(name):
    made = function_name(name)
    return made + "_" if made in RESERVED else made


def in_python(root):
    """Operations with a "yes" under Python in the table of docs/plugins.md."""
    table = (root / "docs" / "plugins.md").read_text()
    rows = [[cell.strip() for cell in line.strip("| ").split("|")]
            for line in table.splitlines() if line.startswith("| ")]
    column = next(row for row in rows if row[0] == "operation").index("Python")
    return [row[0].strip("`") for row in rows
            if row[0].startswith("`") and len(row) > column and row[column] == "yes"]


def python_page(root, table):
    """Functions from the table of operations; values and errors from the module's docstrings."""
    module = root / "plugins" / "python" / "mimetra"
    lines = [PYTHON, "## Values", "", *classes(module / "_data.py", "Data")]
    lines += ["## Errors", "", *classes(module / "_errors.py", "Error"), "## Functions", ""]
    known = in_python(root)
    for operation in table:
        if operation["name"] in known:
            lines += function(operation)
    return "\n".join(lines)


def classes(path, base):
    """A class of a module and its subclasses, with their docstrings."""
    lines = []
    for node in ast.parse(path.read_text()).body:
        if not isinstance(node, ast.ClassDef) or node.name.startswith("_"):
            continue
        bases = [each.id for each in node.bases if isinstance(each, ast.Name)]
        text = ast.get_docstring(node)
        if text and (node.name == base or base in bases):
            lines += [f"### {node.name}", "", "```python", f"mimetra.{call_of(node)}", "```", "",
                      text, ""]
    return lines


def call_of(node):
    for each in node.body:
        if isinstance(each, ast.FunctionDef) and each.name == "__init__":
            taken = ast.unparse(each.args).removeprefix("self").lstrip(", ")
            return f"{node.name}({taken})"
    return node.name


def function(operation):
    """One function: its call and its arguments."""
    inputs = operation.get("inputs", [])
    outputs = operation.get("outputs", [])
    first = [python_name(each["name"]) for each in inputs
             if not each["optional"] and not each["named"]]
    name = function_name(operation["name"])
    lines = [f"### {name}", "", operation["summary"] + ".", "", "```python",
             f"mimetra.{name}({', '.join([*first, '*', '...'])})", "```", "",
             "| argument | type | default | |", "| --- | --- | --- | --- |"]
    for each in inputs:
        kind = each["kind"] + (", or a list of them" if each["repeated"] else "")
        lines.append(row(each["name"], kind, "None" if each["optional"] else "", each["help"]))
    for each in operation.get("parameters", []):
        default = each["default"]
        shown = repr(tuple(default) if isinstance(default, list) else default)
        lines.append(row(each["name"], TYPES[each["kind"]], shown, each["help"] + notes(each)))
    for each in outputs:
        lines.append(row(each["name"], "bool or path", str(not each["optional"]),
                         "True makes it, a path writes it: " + each["help"]))
    return [*lines, ""]


def row(name, kind, default, text):
    cells = [f"`{python_name(name)}`", kind, f"`{default}`" if default else "", text]
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def notes(parameter):
    """Choices, range and unit of a parameter."""
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
