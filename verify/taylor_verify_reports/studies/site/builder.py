"""Builder of the whole site: docs, report and scenes, made by Sphinx from one source folder."""

from __future__ import annotations

import os
import re
import warnings
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from taylor_verify.batch.pool import available_cores
from taylor_verify.records import schema
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify_reports.studies.site.pages import staged
from taylor_verify_reports.studies.site.site_work import Work, unfinished

MADE_BY: Final = "<!-- made by taylor-verify publish --site; do not edit -->"
FRONT: Final = "index.html"
SCHEMA: Final = "verdicts.schema.json"

# Modules that the site needs; their packages have these names with hyphens.
_NEEDED: Final = (
    "sphinx",
    "myst_nb",
    "ipykernel",
    "furo",
    "sphinx_copybutton",
    "latex2mathml",
    "matplotlib",
)
# Patterns of pages; other Markdown is copied as files.
_PAGES: Final = ["index.md", "docs/**", "reports/**"]
# Tables have tens of thousands of code spans and cells. Shorter HTML for them saves a tenth of the site.
_SHORTER: Final = {
    r'<code class="docutils literal notranslate"><span class="pre">([^<]*)</span></code>': (
        r'<code class="literal">\1</code>'
    ),
    r'<tr class="row-(?:even|odd)">': "<tr>",
    r"(<td[^>]*>)<p>([^<]*)</p></td>": r"\1\2</td>",
}
# Endings of files of Sphinx and the theme that no page needs.
_UNNEEDED: Final = (".buildinfo", ".inv", ".map")


def build(folder: Path, target: Path) -> list[Path]:
    """Make the site of the report in ``folder``, in place of an earlier one in ``target``.

    The site has the pages of docs if the folder lies in a checkout. Returns the files written. Raises
    ImportError without Sphinx or another package that it needs, OSError for files that cannot be read or
    written, and ValueError for invalid data, for pages with a fault, and for a target with other files.
    """
    stale = _earlier(target)
    return list(replace_files(target, contents(folder), stale=stale))


def contents(folder: Path) -> dict[str, str | bytes]:
    """Return every file of the site by its path. Raises the errors of `build`."""
    for module in _NEEDED:
        if find_spec(module) is None:
            package = module.replace("_", "-")
            raise ImportError(f"expected {package}, got no such package", name=package)
    with unfinished(folder) as work:
        stage = staged(folder, work.drawings)
        source = work.source(stage.files)
        _run_sphinx(source, work, stage.docs or Path(__file__).parent)
        files = [file for file in sorted(work.made.rglob("*")) if file.is_file()]
        site = {
            file.relative_to(work.made).as_posix(): _content(file)
            for file in files
            if not file.name.endswith(_UNNEEDED)
        }
    pages = {name: f"{MADE_BY}\n{page}" for name, page in stage.motions.items()}
    return {**site, **pages, SCHEMA: schema.text()}


def _run_sphinx(source: Path, work: Work, settings: Path) -> None:
    """Build all pages. Raises a ValueError with Sphinx's warnings, because each is a fault of a page."""
    from sphinx.application import Sphinx
    from sphinx.util.docutils import docutils_namespace, patch_docutils

    with (
        warnings.catch_warnings(),
        patch_docutils(settings),
        docutils_namespace(),
        work.warnings.open("a", buffering=1, encoding="utf-8") as messages,
    ):
        # Python's own warnings, about calls between Sphinx and its extensions, are no faults of pages.
        warnings.simplefilter("ignore")
        app = Sphinx(
            srcdir=source,
            confdir=settings,
            outdir=work.made,
            doctreedir=source.parent / "doctrees",
            buildername="html",
            confoverrides={"include_patterns": _PAGES},
            status=None,
            warning=messages,
            parallel=available_cores(),
        )
        # Without the index of the search, which is written last, it would be one of the other pages.
        app.build(force_all=not (work.made / "searchindex.js").exists())
    warned = work.warnings.read_text(encoding="utf-8")
    if faults := warned.replace(f"{source.resolve()}{os.sep}", ""):
        lines = dict.fromkeys(re.sub(r"\x1b\[[\d;]*m", "", faults).strip().splitlines())
        raise ValueError(f"expected pages without a fault, got {'; '.join(lines)}")


def _content(file: Path) -> str | bytes:
    """Return the content of a file; a page is shortened, and begins with the name of its maker."""
    if file.suffix != ".html":
        return file.read_bytes()
    text = file.read_text(encoding="utf-8")
    for long, short in _SHORTER.items():
        text = re.sub(long, short, text)
    return f"{MADE_BY}\n{text}"


def _earlier(target: Path) -> list[Path]:
    """Return the files of an earlier site. Raises ValueError for a folder with other files."""
    files = [file for file in target.rglob("*") if file.is_file()] if target.exists() else []
    if files and not ((target / FRONT).exists() and first_line(target / FRONT) == MADE_BY):
        raise ValueError(f"expected a folder that is empty or has an earlier site, got {target}")
    return files
