"""Checks the documents: links, anchors and pictures, the options of commands, and the pages whose
commands can be run.

usage: check_docs.py --mimetra MIMETRA [--run PAGE ... | --no-run]

Without --run and --no-run all is checked; --run runs these pages only, which are named below docs/
without .md. In a page that is run, all blocks ```sh are run in its order in one fresh folder, and
each line of a block ```text is the beginning of a line that the block ```sh before it printed:
numbers to within 5 percent, and of warnings what stands before the first number. What depends on
the machine is shown in blocks ```console, which are not compared.
"""

import argparse
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
RUN = ["tutorial", "howto/scan", "howto/arkit", "howto/cluster", "howto/videos",
       *(f"algorithms/{page.stem}" for page in PAGES
         if page.parent.name == "algorithms" and "\nmimetra sample " in page.read_text())]
# Pages all of whose options are the command's.
OPTION_PAGES = [ROOT / "docs" / "glossary.md", *sorted((ROOT / "docs" / "algorithms").glob("*.md"))]
# Operations of the example plugins.
PLUGIN_COMMANDS = {"smooth", "speed"}

FENCE = re.compile(r"^ *```(\w*)[^\n]*\n(.*?)^ *```", re.MULTILINE | re.DOTALL)
INLINE_CODE = re.compile(r"(?<!`)`([^`\n]+)`(?!`)")
LINK = re.compile(r"\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
TOLERANCE = 0.05


def without_code(text):
    return INLINE_CODE.sub("", FENCE.sub("", text))


def anchors(text):
    """Those that a Git forge gives to headings."""
    found = set()
    for heading in re.findall(r"^#+ +(.*?) *$", FENCE.sub("", text), re.MULTILINE):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        number = 0
        while (slug if number == 0 else f"{slug}-{number}") in found:
            number += 1
        found.add(slug if number == 0 else f"{slug}-{number}")
    return found


def link_errors(page):
    """Links and pictures of a page that lead to nothing."""
    for target in LINK.findall(without_code(page.read_text())):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.is_relative_to(ROOT) or not file.exists():
            yield f"{target}: is not there"
        elif anchor and file.suffix == ".md" and anchor not in anchors(file.read_text()):
            yield f"{target}: {file.relative_to(ROOT)} has no such heading"


class Command:
    """The built command."""

    def __init__(self, path):
        self.path = path.resolve()
        self.options = {}
        self.names = set(re.findall(r"^  ([a-z]+) ", self.printed("--help"), re.MULTILINE))

    def printed(self, *arguments):
        return subprocess.run([self.path, *arguments], check=True, text=True, capture_output=True,
                              env=environment()).stdout

    def options_of(self, name):
        if name not in self.options:
            text = self.printed(name, "--help", "all")
            found = re.findall(r"^  (-.*?)(?:  |$)", text, re.MULTILINE)
            self.options[name] = {"-h", "--help"} | {
                option for each in found for option in re.findall(r"--?[a-z][\w-]*", each)}
        return self.options[name]

    def knows_somewhere(self, option):
        return any(option in self.options_of(name) for name in self.names)


def environment():
    """Without plugins of the user's, which would add commands."""
    return {name: value for name, value in os.environ.items() if name != "MIMETRA_PLUGIN_PATH"}


def shell_lines(code):
    return code.replace("\\\n", " ").splitlines()


def words_of(line):
    try:
        return shlex.split(line, comments=True)
    except ValueError:
        return line.split()


def option_errors(text, command):
    """Options of `mimetra ...` in code that the command does not know."""
    code = [line for _, block in FENCE.findall(text) for line in shell_lines(block)]
    code += [each for each in INLINE_CODE.findall(FENCE.sub("", text))
             if each.startswith("mimetra ") and each.split()[1] in command.names]
    for line in code:
        words = words_of(line)
        places = [at for at, word in enumerate(words[:-1])
                  if word == "mimetra" or word.endswith("/bin/mimetra")]
        if not places or not re.fullmatch(r"[a-z]+", words[places[-1] + 1]):
            continue
        name, *rest = words[places[-1] + 1:]
        if name in PLUGIN_COMMANDS or places[-1] > 0 and words[places[-1] - 1].endswith(".sh"):
            continue
        if name not in command.names:
            yield f"{line.strip()}: no command '{name}'"
            continue
        for word in rest:
            option = word.split("=")[0]
            if word in (";", "&&", "|", "||"):
                break
            if re.match(r"--?[a-z]", option) and option not in command.options_of(name):
                yield f"{line.strip()}: '{name}' has no option {option}"


def named_option_errors(text, command):
    """Options that a page names and no command has."""
    for code in INLINE_CODE.findall(FENCE.sub("", text)):
        for option in re.findall(r"(?:^|\s)(--[a-z][-\w]*)", code):
            if not command.knows_somewhere(option):
                yield f"{option}: is no option of any command"


def matches(expected, line):
    """Whether a printed line begins as a document says."""
    if expected.startswith("mimetra: warning:"):
        beginning = NUMBER.split(expected)[0]
        return line.startswith(beginning)
    pattern = r"(-?\d[\d.]*(?:e[-+]?\d+)?)".join(re.escape(part) for part in NUMBER.split(expected))
    found = re.match(pattern.replace(r"\ ", " "), line)
    return bool(found) and all(
        abs(float(said) - float(printed.rstrip("."))) <= TOLERANCE * abs(float(said))
        for said, printed in zip(NUMBER.findall(expected), found.groups()))


def run_errors(page, command):
    """Runs a page; what fails, and what it says that is not printed."""
    with tempfile.TemporaryDirectory() as folder:
        tools = pathlib.Path(folder, "tools")
        work = pathlib.Path(folder, "work")
        tools.mkdir()
        work.mkdir()
        (tools / "mimetra").symlink_to(command.path)
        own = environment() | {"PATH": f"{tools}:{os.environ['PATH']}"}
        printed = []
        for language, block in FENCE.findall(page.read_text()):
            if language == "sh":
                done = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=work, env=own,
                                      text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                printed = done.stdout.splitlines()
                if done.returncode != 0:
                    yield f"exit code {done.returncode} of\n{block}{done.stdout}"
                    return
            elif language == "text":
                for line in block.splitlines():
                    if not any(matches(line, each) for each in printed):
                        yield "\n  ".join([f"is not printed: {line}", *printed])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mimetra", type=pathlib.Path, required=True, help="the built command")
    parser.add_argument("--run", nargs="*", metavar="PAGE", help="run these pages only")
    parser.add_argument("--no-run", action="store_true", help="run no page")
    arguments = parser.parse_args()
    command = Command(arguments.mimetra)
    errors = []
    if arguments.run is None:
        for page in PAGES:
            text, name = page.read_text(), page.relative_to(ROOT)
            errors += [f"{name}: {each}" for each in link_errors(page)]
            errors += [f"{name}: {each}" for each in option_errors(text, command)]
            if page in OPTION_PAGES:
                errors += [f"{name}: {each}" for each in named_option_errors(text, command)]
    for name in [] if arguments.no_run else arguments.run or RUN:
        page = ROOT / "docs" / f"{name}.md"
        errors += [f"docs/{name}.md: {each}" for each in run_errors(page, command)]
    for error in errors:
        print(error, file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
