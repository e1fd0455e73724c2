"""Prints the ten longest build steps and tests since a time.

usage: longest.py BUILD TESTS SECONDS

BUILD holds a folder for each build; TESTS is where ctest ran; SECONDS is a time as `date +%s` prints
it.
"""

import pathlib
import re
import sys


def build_steps(build, since):
    """[seconds, name] of each step in Ninja's logs that started since then.

    A line has milliseconds of start and end, the time of its start, an output and the command."""
    for log in build.glob("*/.ninja_log"):
        steps = {}
        for line in log.read_text().splitlines()[1:]:
            fields = line.split("\t")
            if len(fields) == 5 and int(fields[2]) >= since * 10**9:
                start, end, _, output, command = fields
                steps[start, end, command] = output
        for (start, end, _), output in steps.items():
            name = re.sub(r"CMakeFiles/\w+\.dir/|_cxx\.cxx\.o$|\.cpp\.o$", "", output)
            yield (int(end) - int(start)) / 1000, f"{log.parent.name}: {name}"


def tests(folder):
    """[seconds, name] of each test in the log of ctest's last run."""
    name = ""
    for log in (folder / "Testing/Temporary").glob("LastTest.log*"):
        for line in log.read_text(errors="replace").splitlines():
            if match := re.match(r"\d+/\d+ Testing: (.+)", line):
                name = match[1]
            elif match := re.match(r"Test time = +([0-9.]+) sec", line):
                yield float(match[1]), name


def main():
    build, folder, since = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    for title, rows in (("build steps", build_steps(build, since)), ("tests", tests(folder))):
        rows = sorted(rows, reverse=True)
        print(f"\nTen longest {title} of {len(rows)}, {sum(row[0] for row in rows):.0f} s in all:")
        for seconds, name in rows[:10]:
            print(f"{seconds:8.1f} s  {name}")


main()
