"""Builds the documentation site from docs/, the public headers and the table of operations.

usage: build.py MIMETRA OUT

MIMETRA is the built command. OUT becomes a folder of pages that need no network and no server.
Intermediate files go to OUT-work.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys

from pages import Pages
from references import cpp_page, main_page_of_cpp, public_headers, python_page, samples_page

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = ROOT / "docs" / "site"

REPORT = """# A report

`mimetra report` makes one page of a run for a browser: source and target in 3D, strips, components
and Table I. These commands make the report of the built-in sample:

```sh
{commands}
```

<p><a class="reference" href="report_of_sample.html">Open it</a> in a window of its own.</p>

<iframe class="report" src="report_of_sample.html" title="A report of the built-in sample"></iframe>
"""

REPORT_COMMANDS = (
    "sample -o head",
    "convert head@identity001=1 --weights head/performance.csv -o source",
    "transfer source head@identity002=1 -k 30 -o result",
    "report result -k 10,30,40 --unit mm -o report.html",
)


def version():
    """The version of the CMake project."""
    return re.search(r"project\(mimetra VERSION ([0-9.]+)",
                     (ROOT / "CMakeLists.txt").read_text()).group(1)


def run(*command, cwd=ROOT):
    subprocess.run([str(word) for word in command], cwd=cwd, check=True)


def make_report(mimetra, work, out):
    """Writes the report of the built-in sample and returns the text of the page that shows it."""
    folder = work / "run"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for command in REPORT_COMMANDS:
        run(mimetra, *command.split(), "--quiet", cwd=folder)
    shutil.copy(folder / "report.html", out / "report_of_sample.html")
    return REPORT.format(commands="\n".join("mimetra " + each for each in REPORT_COMMANDS))


def layout(work):
    """Writes Doxygen's own layout with a link back to the site."""
    path = work / "doxygen_layout.xml"
    run("doxygen", "-l", path)
    back = '<tab type="user" visible="yes" url="../index.html" title="mimetra documentation"/>'
    path.write_text(path.read_text().replace("<navindex>", f"<navindex>\n    {back}"))
    return path


def make_cpp(work, out):
    """Runs Doxygen on the public headers and returns their paths."""
    headers = public_headers(ROOT)
    main_page = work / "cpp_main_page.md"
    main_page.write_text(main_page_of_cpp(headers))
    inputs = " ".join(f'"{path}"' for path in [main_page, *headers])
    settings = (SITE / "Doxyfile").read_text() + (
        f'\nPROJECT_NUMBER = {version()}\nINPUT = {inputs}\n'
        f'USE_MDFILE_AS_MAINPAGE = "{main_page}"\n'
        f'STRIP_FROM_INC_PATH = "{ROOT}"\nOUTPUT_DIRECTORY = "{out}"\n'
        f'HTML_EXTRA_STYLESHEET = "{SITE / "reference.css"}"\n'
        f'INPUT_FILTER = "python3 -B {SITE / "doxygen_filter.py"}"\n'
        f'LAYOUT_FILE = "{layout(work)}"\nWARN_LOGFILE = "{work / "doxygen.log"}"\n')
    subprocess.run(["doxygen", "-"], input=settings, text=True, cwd=ROOT, check=True)
    return headers


def take_in_style_sheets(folder):
    """Copies the style sheets that Debian's theme imports from a web server into its folder."""
    for path in folder.glob("*.css"):
        def copied(match):
            sheet = pathlib.Path("/usr/share/javascript", match.group(1))
            shutil.copy(sheet, folder / sheet.name)
            return f"url({sheet.name})"

        path.write_text(re.sub(r"url\(/javascript/([^)]+)\)", copied, path.read_text()))


def main(mimetra, out):
    mimetra, out = pathlib.Path(mimetra).resolve(), pathlib.Path(out).resolve()
    work = out.with_name(out.name + "-work")
    shutil.rmtree(out, ignore_errors=True)
    shutil.rmtree(work, ignore_errors=True)
    for folder in (out, work):
        folder.mkdir(parents=True)

    table = json.loads(subprocess.check_output([mimetra, "operations", "--json"]))["operations"]
    headers = make_cpp(work, out)
    pages = Pages(ROOT, work / "pages", out / "cpp", headers)
    pages.add_documents()
    pages.add("python.md", python_page(ROOT, table))
    pages.add("cpp.md", cpp_page(ROOT, headers))
    pages.add("samples.md", samples_page(ROOT))
    pages.add("report.md", make_report(mimetra, work, out))
    pages.finish()
    run("sphinx-build", "-q", "-W", "--keep-going", "-b", "html", "-c", SITE,
        "-d", work / "doctrees", "-D", f"release={version()}", work / "pages", out)
    take_in_style_sheets(out / "_static" / "styles")
    print(out / "index.html")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
