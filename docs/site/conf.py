"""Settings of Sphinx for the site; build.py calls it."""

from docutils.nodes import SkipNode
from docutils.utils.math.latex2mathml import tex2mathml

project = "mimetra"
extensions = ["myst_parser"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
highlight_language = "none"

html_theme = "furo"
html_title = "mimetra"
html_static_path = ["site.css", "/usr/share/fonts/opentype/stix-word/STIXMath-Regular.otf"]
html_css_files = ["site.css"]
html_copy_source = html_show_sourcelink = html_show_copyright = False
html_math_renderer = "mathml"
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#1f5f8b", "color-brand-content": "#1f5f8b"},
    "dark_css_variables": {"color-brand-primary": "#7fb8de", "color-brand-content": "#7fb8de"},
}


def mathml(text, inline):
    """MathML, which browsers draw without a script or a web font."""
    return tex2mathml(text, inline)


def inline_math(writer, node):
    writer.body.append(mathml(node.astext(), True))
    raise SkipNode


def block_math(writer, node):
    writer.body.append(f'<div class="math">{mathml(node.astext(), False)}</div>\n')
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (inline_math, None), (block_math, None))
