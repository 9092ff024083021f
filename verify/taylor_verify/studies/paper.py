"""The renderings of a report folder, beside its tables: NAME.tex, NAME.html, and paper.tex of them all.

They are made of the pages that are there and of nothing else: whoever changes a page makes these anew. The
pictures of the pages are drawn as PDF, which LaTeX takes.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify.publish.paper import FOLDER, HTML, LATEX, MAKERS, Page, html, latex, paper
from taylor_verify.publish.pictures.picture import save
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.studies import figures, registry

PAPER: Final = f"paper{LATEX}"
_TITLE: Final = "Verification of a Taylor integrator on Euler's and Kirchhoff's equations"

# In the order in which a reader of the whole wants them. The gates are left out: a line for each of some
# thousands of verdicts, with its reason in words, is for searching, and gates.csv is for that.
PAGES: Final = (
    "tables/README.md",
    *("tables/accuracy.md", "tables/attainable.md", "tables/conserved.md"),
    # The README of another folder is an index of files, and no page to be read.
    *(study.path for study in registry.others() if "README" not in study.path),
    "tables/traps.md",
)


def write(folder: Path) -> list[Path]:
    """Render every page of ``folder`` that is there, and draw the pictures that are there as PDF.

    Renderings of pages that are gone are removed.

    Raises OSError for files that cannot be read or written, ValueError for a page that is none, and
    ImportError without pypandoc or, where there are pictures, matplotlib.
    """
    texts = renderings(folder)
    drawn: list[Path] = []
    if there := {file.stem for file in (folder / figures.FOLDER).glob("*.svg")}:
        pictures = [picture for picture in registry.pictures(folder) if picture.stem in there]
        drawn = save(pictures, folder / figures.FOLDER, ("pdf",))
    earlier = [file for suffix in MAKERS for file in (folder / FOLDER).glob(f"*{suffix}")]
    own = [file for file in earlier if first_line(file) == MAKERS[file.suffix]]
    return [*replace_files(folder, texts, stale=own), *drawn]


def renderings(folder: Path) -> dict[str, str]:
    """Return every file by its path below ``folder``; nothing for a folder without pages."""
    pages = [
        Page(path, (folder / path).read_text(encoding="utf-8"))
        for path in PAGES
        if (folder / path).exists()
    ]
    paths = [page.path for page in pages]
    texts: dict[str, str] = {}
    for page in pages:
        texts[f"{FOLDER}/{page.stem}{LATEX}"] = latex(page)
        texts[f"{FOLDER}/{page.stem}{HTML}"] = html(page, paths)
    if pages:
        texts[f"{FOLDER}/{PAPER}"] = paper(_TITLE, [page.stem for page in pages])
    return texts
