"""Whole site: every page of docs, report and scenes, made by Sphinx from one source folder."""

from __future__ import annotations

import os
import re
import warnings
from importlib import resources
from importlib.util import find_spec
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from taylor_verify.batch.pool import available_cores
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.studies.site.pages import staged

MADE_BY: Final = "<!-- made by taylor-verify publish --site; do not edit -->"
FRONT: Final = "index.html"

_SCRIPT: Final = "plotly.min.js"
# Modules to import; pip knows them by these names with hyphens.
_NEEDED: Final = (
    "sphinx",
    "myst_nb",
    "ipykernel",
    "furo",
    "sphinx_copybutton",
    "latex2mathml",
    "matplotlib",
    "plotly",
)
# Other Markdown comes along as files.
_PAGES: Final = ["index.md", "docs/**", "reports/**"]
# Tables have tens of thousands of code spans and cells: a tenth of the site would be these marks.
_SHORTER: Final = {
    r'<code class="docutils literal notranslate"><span class="pre">([^<]*)</span></code>': (
        r'<code class="literal">\1</code>'
    ),
    r'<tr class="row-(?:even|odd)">': "<tr>",
    r"(<td[^>]*>)<p>([^<]*)</p></td>": r"\1\2</td>",
}
# What Sphinx and the theme's authors write for themselves.
_OWN: Final = (".buildinfo", ".inv", ".map")


def build(folder: Path, target: Path) -> list[Path]:
    """Make the site of the report in ``folder`` in place of an earlier one in ``target``.

    The pages of docs are part of it where the folder lies in a checkout. Returns the files written.
    Raises ImportError without Sphinx or another package that it asks for, OSError for files that
    cannot be read or written, and ValueError for data that are none, for pages with a fault, and for
    a target that holds something else.
    """
    stale = _earlier(target)
    return list(replace_files(target, contents(folder), stale=stale))


def contents(folder: Path) -> dict[str, str | bytes]:
    """Return every file of the site by its place in it. The errors are those of `build`."""
    for module in _NEEDED:
        if find_spec(module) is None:
            package = module.replace("_", "-")
            raise ImportError(f"expected {package}, got no such package", name=package)
    stage = staged(folder)
    with TemporaryDirectory(prefix="taylor-verify-site-") as place:
        source, made = Path(place, "source"), Path(place, "made")
        replace_files(source, stage.files)
        _run_sphinx(source, made, stage.docs or Path(__file__).parent)
        files = [file for file in sorted(made.rglob("*")) if file.is_file()]
        site = {
            file.relative_to(made).as_posix(): _content(file)
            for file in files
            if not file.name.endswith(_OWN)
        }
    # No page loads Plotly's script before a motion comes into view.
    plotly = resources.files("plotly") / "package_data" / _SCRIPT
    return {**site, f"_static/{_SCRIPT}": plotly.read_bytes()}


def _run_sphinx(source: Path, target: Path, settings: Path) -> None:
    """Build all pages. Raises ValueError with every warning, for each is a fault of a page."""
    from sphinx.application import Sphinx
    from sphinx.util.docutils import docutils_namespace, patch_docutils

    messages = StringIO()
    with warnings.catch_warnings(), patch_docutils(settings), docutils_namespace():
        # What Sphinx and its extensions think of each other's calls is no fault of a page.
        warnings.simplefilter("ignore")
        app = Sphinx(
            srcdir=source,
            confdir=settings,
            outdir=target,
            doctreedir=source.parent / "doctrees",
            buildername="html",
            confoverrides={"include_patterns": _PAGES},
            status=None,
            warning=messages,
            parallel=available_cores(),
        )
        app.build()
    if faults := messages.getvalue().replace(f"{source.resolve()}{os.sep}", ""):
        lines = re.sub(r"\x1b\[[\d;]*m", "", faults).strip().replace("\n", "; ")
        raise ValueError(f"expected pages without a fault, got {lines}")


def _content(file: Path) -> str | bytes:
    """Return a file as it is; a page with its maker's name in front."""
    if file.suffix != ".html":
        return file.read_bytes()
    text = file.read_text(encoding="utf-8")
    for wordy, short in _SHORTER.items():
        text = re.sub(wordy, short, text)
    return f"{MADE_BY}\n{text}"


def _earlier(target: Path) -> list[Path]:
    """Return the files of an earlier site. Raises ValueError for a folder with somebody else's."""
    files = [file for file in target.rglob("*") if file.is_file()] if target.exists() else []
    if files and not ((target / FRONT).exists() and first_line(target / FRONT) == MADE_BY):
        raise ValueError(f"expected a folder that is empty or has an earlier site, got {target}")
    return files
