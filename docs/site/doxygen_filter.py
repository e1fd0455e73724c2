"""Prints a header as Doxygen should read it; its comments are written for people.

usage: doxygen_filter.py HEADER

An @, as in `actor@wide=1.5`, is not a Doxygen command. A comment before a namespace documents the
file. The C header does not mark its comments as documentation: all comments except section headings
become documentation, and comments of several lines keep their layout.
"""

import re
import sys


def of_cpp(text):
    text = re.sub(r"^ *///.*$", lambda line: line.group().replace("@", "\\@"), text,
                  flags=re.MULTILINE)
    return re.sub(r"((?:^///.*\n)+)(?=namespace )", r"/// \\file\n\1", text, flags=re.MULTILINE)


def of_c(text):
    first = True

    def documented(match):
        nonlocal first
        before, comment = match.groups()
        if comment.startswith("/* --"):
            return match.group()
        if before.strip():
            return f"{before}/**<{comment[2:]}"
        if "\n" not in comment:
            return f"{before}/**{comment[2:]}"
        about, first = ("\\file\n * " if first else ""), False
        inner = re.sub(r"^/\*\n?|\n? *\*/$", "", comment)
        inner = re.sub(r"^ *\* ?", "", inner, flags=re.MULTILINE)
        return f"{before}/** {about}\\verbatim\n{inner}\n\\endverbatim */"

    return re.sub(r"([^\n]*?)(/\*[\s\S]*?\*/)", documented, text)


def main(path):
    with open(path) as header:
        text = header.read()
    print(of_c(text) if path.endswith("plugins/c/mimetra.h") else of_cpp(text), end="")


if __name__ == "__main__":
    main(sys.argv[1])
