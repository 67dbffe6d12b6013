"""The manual as HTML, by Sphinx: `./abbe docs` builds it. The pages are Markdown, which GitHub shows as well."""
import pathlib
import re

from pygments.lexers.javascript import JavascriptLexer
from pygments.lexers.special import TextLexer

project = "Abbe"
html_title = "Abbe manual"
extensions = ["myst_parser"]
root_doc = "README"
exclude_patterns = ["notebooks"]
myst_heading_anchors = 4
html_theme = "alabaster"
html_theme_options = {
    "description": "A spectral renderer validated against measured colour science",
    "extra_nav_links": {"C++ interface": "api/index.html"},
    "page_width": "1200px",
    "sidebar_width": "260px",
    "body_max_width": "none",
    "fixed_sidebar": True,
    "font_family": "sans-serif",
    "head_font_family": "sans-serif",
    "font_size": "16px",
    "code_font_size": "0.78em",
}
html_sidebars = {"**": ["about.html", "searchbox.html", "navigation.html"]}
html_show_copyright = False
html_show_sourcelink = False
html_copy_source = False
highlight_language = "none"


def add_contents(app, name, source):
    """Sphinx orders pages by a toctree: here by the links of the first page, under its headings."""
    if name != root_doc:
        return
    for caption, section in re.findall(r"^## ([^\n]*)\n(.*?)(?=^## |\Z)", source[0], re.MULTILINE | re.DOTALL):
        pages = dict.fromkeys(re.findall(r"^[-|][^\n]*?\]\((\w[\w/]*)\.md\)", section, re.MULTILINE))
        if caption in ("Guide", "Reference", "Development"):
            source[0] += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n" + "\n".join(pages) + "\n```\n"


def setup(app):
    app.add_lexer("jsonc", JavascriptLexer)  # JSON with comments
    app.add_lexer("csv", TextLexer)
    app.connect("source-read", add_contents)
