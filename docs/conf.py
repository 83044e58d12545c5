"""The site: guides, notebooks and references in one search. `sphinx-build -W docs site` builds it, with tabor installed."""

import re
import subprocess
import sys
from pathlib import Path

import tabor

DOCS = Path(__file__).parent
ROOT = DOCS.parent
GENERATED = DOCS / "generated"
COMMANDS = ["new", "run", "check", "surface", "theory", "compare", "accuracy", "fit", "sweep", "plot", "devices", "completions", "man"]

# Pages that lie elsewhere in the repository, and their names here.
PAGES = {
    "README.md": "readme.md",
    "CHANGELOG.md": "changes.md",
    "python/README.md": "python.md",
    "benches/peers/README.md": "peers.md",
}

project = "tabor"
version = release = tabor.__version__
html_show_copyright = False
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
html_theme = "furo"
html_title = f"tabor {release}"

myst_enable_extensions = ["attrs_inline"]
# Headings of a page can be linked to, as on code hosts.
myst_heading_anchors = 4
# A notebook that fails, or that takes longer than this, fails the site.
nb_execution_mode = "cache"
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_merge_streams = True

autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_default_options = {"members": True}
napoleon_use_ivar = True
suppress_warnings = ["mystnb.unknown_mime_type"]


def words(*arguments):
    """What the program prints."""
    done = subprocess.run([sys.executable, "-m", "tabor", *arguments], capture_output=True, text=True, check=True, cwd=DOCS)
    return done.stdout.rstrip()


def command_line():
    """The help of each command."""
    page = ["# Command line", "", "```text", words("--help"), "```", ""]
    for command in COMMANDS:
        page += [f"## tabor {command}", "", "```text", words(command, "--help"), "```", ""]
    page += ["## Models of tabor theory", "", "```text", words("theory"), "```", ""]
    return "\n".join(page)


def rust():
    """The crate page, without the links that only rustdoc resolves."""
    lines = (ROOT / "src" / "lib.rs").read_text(encoding="utf-8").splitlines()
    text = "\n".join(line[3:].removeprefix(" ") for line in lines if line.startswith("//!"))
    text = re.sub(r"\[([^]]+)\]\((?:fn|mod|struct)@[^)]*\)", r"\1", text)
    text = re.sub(r"^(#+ )", r"#\1", text, flags=re.MULTILINE)
    return f"# Rust\n\n`cargo doc --open` has every type and function; this is the page of the crate.\n\n{text}\n"


def elsewhere(path):
    """A page that lies elsewhere in the repository, its links turned to where the site has them."""
    text = (ROOT / path).read_text(encoding="utf-8")
    for there, here in PAGES.items():
        text = text.replace(f"]({there})", f"]({here})")
    return text.replace("](docs/", "](../").replace("](../docs/", "](../")


def turned(_app, _name, source):
    """Links of a guide to pages that lie elsewhere."""
    for there, here in PAGES.items():
        source[0] = source[0].replace(f"](../{there})", f"](generated/{here})")


def setup(app):
    """Called by Sphinx."""
    app.connect("source-read", turned)


GENERATED.mkdir(exist_ok=True)
pages = {"command_line.md": command_line(), "rust.md": rust(), **{here: elsewhere(there) for there, here in PAGES.items()}}
for name, page in pages.items():
    path = GENERATED / name
    # One that is as it was need not be read again.
    if not path.is_file() or path.read_text(encoding="utf-8") != page:
        path.write_text(page, encoding="utf-8")
