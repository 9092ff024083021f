"""Pack of the paper: paper.pdf, paper.tex with its pictures, and each table alone as LaTeX and CSV.

It is made from stored rows, stored pictures and `text.md` beside this file. That text has marks such as
§{engines} for findings, tables, pictures and their numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Final

from taylor_verify.plotting.picture import Picture, save
from taylor_verify.records.replacement import replace_files
from taylor_verify.records.store import versions
from taylor_verify.words.markdown import prose
from taylor_verify.words.page_parts import packages
from taylor_verify_reports.studies import figures, registry
from taylor_verify_reports.studies.paper.illustration import pictures
from taylor_verify_reports.studies.paper.paper_findings import FINDINGS
from taylor_verify_reports.studies.paper.sources import read
from taylor_verify_reports.studies.paper.table import Table, tables
from taylor_verify_reports.typesetting import paper

FOLDER: Final = "paper"
PDF: Final = "paper.pdf"
LATEX: Final = "paper.tex"

_TEXT: Final = Path(__file__).with_name("text.md")
_CITATION: Final = "CITATION.cff"


class _Marked(Template):
    """A text with marks such as §{table:engines}."""

    delimiter = "§"
    idpattern = r"[a-z]+(?::[a-z]+)?"


@dataclass(frozen=True)
class Pack:
    """The paper of one report: its text, its tables and its pictures, in the order of the text."""

    text: str
    tables: Sequence[Table]
    pictures: Sequence[Picture]
    citation: Path

    def write(self, place: Path) -> list[Path]:
        """Write all files into a folder and return them.

        Raises OSError, and ImportError without pypandoc, typst or matplotlib.
        """
        drawn = save(self.pictures, place, ("pdf",))
        files: dict[str, str | bytes] = {
            LATEX: paper.latex(self.text, self.citation),
            PDF: paper.pdf(self.text, self.citation, place),
        }
        for table in self.tables:
            files[f"{table.name}.tex"] = paper.latex_table(table.markdown)
            files[f"{table.name}.csv"] = table.csv
        return [*replace_files(place, files), *drawn]


def write(folder: Path) -> list[Path]:
    """Write the pack into ``folder``/paper, and each picture of ``folder``/figures as PDF beside its SVG.

    Returns the files written. Raises the errors of `pack` and of `Pack.write`.
    """
    drawings = folder / figures.FOLDER
    stems = {file.stem for file in drawings.glob("*.svg")}
    whole_pack = pack(folder)
    drawn = [picture for picture in registry.pictures(folder) if picture.stem in stems]
    written = whole_pack.write(folder / FOLDER)
    return [*written, *save(drawn, drawings, ("pdf",))] if drawn else written


def pack(folder: Path) -> Pack:
    """Return the paper of a report folder without writing it.

    Raises OSError for files that cannot be read, and ValueError for a study that is missing, a file that
    holds something else, or a checkout without its CITATION.cff.
    """
    sources = read(folder)
    all_tables, illustrations = tables(sources), pictures(sources)
    values = {
        "versions": prose(packages(versions(sources.verdicts))),
        **{name: finding(sources) for name, finding in FINDINGS.items()},
        **{f"table:{table.name}": f"Table {i}" for i, table in enumerate(all_tables, 1)},
        **{f"tabular:{table.name}": table.markdown for table in all_tables},
        **{f"figure:{shown.name}": f"Figure {i}" for i, shown in enumerate(illustrations, 1)},
        **{f"picture:{shown.name}": shown.markdown for shown in illustrations},
    }
    text = _Marked(_TEXT.read_text(encoding="utf-8")).substitute(values)
    return Pack(
        text=text,
        tables=all_tables,
        pictures=[shown.picture for shown in illustrations],
        citation=_citation(folder),
    )


def _citation(folder: Path) -> Path:
    """Return the CITATION.cff with title and authors, beside the report or in this checkout."""
    places = (folder.resolve().parent, Path(__file__).resolve().parents[4])
    for place in places:
        if (place / _CITATION).is_file():
            return place / _CITATION
    raise ValueError(f"expected {_CITATION} of a checkout, got none @ {places[0]}")
