"""The pages of the site: documents of the repository, with links to their places on the site."""

import os
import pathlib
import posixpath
import re
import shutil

# Entries of the menu in order. The build fails if a document is missing.
# The menu shows an algorithm by the name of its header.
MENU = {
    "Start": ["tutorial", "readme", "gallery", "report", "glossary"],
    "How to": ["howto/scan", "howto/arkit", "howto/videos", "howto/openmesh", "howto/plugin",
               "howto/cluster", "retarget", "rig", "painting", "rules", "large-data"],
    "In other programs": ["paraview", "blender", "meshlab", "plugins"],
    "Algorithms": [
        "algorithms/index", "algorithms/heat_geodesics", "algorithms/exact_geodesics",
        "algorithms/support_map", "algorithms/alignment", "algorithms/decomposition",
        "algorithms/regions", "algorithms/region_completion", "algorithms/region_selection",
        "algorithms/simplification", "algorithms/subdivision",
        "algorithms/deformation_gradients", "algorithms/blendshape_transfer",
        "algorithms/vertex_transfer", "algorithms/soft_border", "algorithms/local_weights",
        "algorithms/transfer_error", "algorithms/linear_transfer", "algorithms/example_rig",
        "algorithms/automatic_markers", "algorithms/correspondence", "algorithms/renumbering",
        "algorithms/landmark_fitter"],
    "Reference": ["commands", "formats", "scenes", "errors", "packages", "python", "cpp", "samples"],
    "Measured": ["accuracy", "performance"],
    "Project": ["contributing", "changelog", "security"],
}

TITLES = {"readme": "Overview", "tutorial": "Tutorial", "algorithms/index": "All algorithms",
          "plugins": "Any program", "retarget": "Weights of another rig",
          "errors": "What is refused"}

# Documents outside docs/, and the page that each becomes.
OUTSIDE = {"README.md": "readme.md", "CONTRIBUTING.md": "contributing.md",
           "CHANGELOG.md": "changelog.md", "SECURITY.md": "security.md"}

FENCE = re.compile(r"^( *)(```+|~~~+).*?^\1?\2 *$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)", re.DOTALL)
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)")


def page_of_header(path):
    """The name of Doxygen's page of a header."""
    return path.name.replace("_", "__").replace(".", "_8") + ".html"


def anchor_of_sample(path):
    return re.sub(r"[^a-z0-9_-]", "", str(path).lower())


def outside_code(text, change):
    """Applies `change` to the text outside code."""
    kept = []

    def keep(match):
        kept.append(match.group())
        return f"\0{len(kept) - 1}\0"

    text = change(FENCE.sub(keep, text), keep)
    for _ in range(2):  # code in a link that was kept
        text = re.sub("\0(\\d+)\0", lambda match: kept[int(match.group(1))], text)
    return text


class Pages:
    """Pages in the folder that Sphinx reads."""

    def __init__(self, root, folder, cpp, headers):
        self.root, self.folder, self.cpp = root, folder, cpp
        self.headers = {pathlib.PurePosixPath(path) for path in headers}
        self.made = set()

    def add(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        self.made.add(name)

    def add_documents(self):
        """Adds all documents of the repository and their pictures."""
        shutil.copytree(self.root / "docs", self.folder,
                        ignore=lambda folder, names: [
                            name for name in names if not name.endswith((".png", ".svg"))
                            and not os.path.isdir(os.path.join(folder, name))])
        for path in sorted((self.root / "docs").rglob("*.md")):
            self.add_document(path.relative_to(self.root),
                              str(path.relative_to(self.root / "docs")))
        for source, name in OUTSIDE.items():
            self.add_document(pathlib.Path(source), name)

    def add_document(self, source, name):
        text = (self.root / source).read_text()
        base, page = pathlib.PurePosixPath(source).parent, pathlib.PurePosixPath(name).parent

        def change(plain, _):
            return LINK.sub(lambda match: self.link(match, base, page, source), plain)

        self.add(name, outside_code(text, change))

    def link(self, match, base, page, source):
        """The link, changed to its place on the site."""
        picture, text, target = match.groups()
        if re.match(r"[a-z]+:|#", target):
            return match.group()
        path, _, anchor = target.partition("#")
        path = pathlib.PurePosixPath(posixpath.normpath(str(base / path)))
        anchor = f"#{anchor}" if anchor else ""
        if str(path) in OUTSIDE:
            return f"{picture}[{text}]({self.way(OUTSIDE[str(path)], page)}{anchor})"
        if path.parts[0] == "docs":
            return f"{picture}[{text}]({self.way(path.relative_to('docs'), page)}{anchor})"
        if path in self.headers:
            name = page_of_header(path)
            if not (self.cpp / name).exists():
                raise SystemExit(f"{source}: {path}: Doxygen made no page cpp/{name}")
            return (f'<a class="reference" href="{self.way(f"cpp/{name}", page)}">{text}</a>')
        if path.parts[0] == "samples" and (self.root / path).exists():
            return f"[{text}]({self.way('samples.md', page)}#{anchor_of_sample(path)})"
        raise SystemExit(f"{source}: {target}: no page of the site shows this file")

    @staticmethod
    def way(target, page):
        return posixpath.relpath(str(target), str(page))

    @staticmethod
    def entry(name):
        """A line of the menu; most lines show the page's title."""
        if name in TITLES:
            return f"{TITLES[name]} <{name}>"
        folder, _, last = name.rpartition("/")
        return f"{last} <{name}>" if folder == "algorithms" else name

    def finish(self):
        """Writes the menu at the end of the first page."""
        names = {name.removesuffix(".md") for name in self.made} - {"index"}
        listed = {name for names in MENU.values() for name in names}
        if names != listed:
            raise SystemExit(f"MENU in docs/site/pages.py: add {sorted(names - listed)}, "
                             f"remove {sorted(listed - names)}")
        lines = []
        for caption, entries in MENU.items():
            lines += ["", "```{toctree}", ":hidden:", f":caption: {caption}", "",
                      *[self.entry(name) for name in entries], "```"]
        with open(self.folder / "index.md", "a") as index:
            index.write("\n".join(lines) + "\n")
