"""Published numbers that pages of the project quote; they are made again with every report.

A page beside the folder `reports` quotes a block of numbers if it has the two marks of that block. Pages
without marks stay as they are, and so do all pages if the report is in another folder.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Final

from taylor_verify.records.precisions import place_of_rung
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import in_roundoffs
from taylor_verify.words.markdown import code, table
from taylor_verify_reports.studies.controls import controls_page as controls
from taylor_verify_reports.studies.controls.sight import CONTROLS

BEGIN: Final = "<!-- accuracy: made by taylor-verify publish; do not edit -->"
END: Final = "<!-- end of accuracy -->"

_FOLDER: Final = "reports"
_PAGES: Final = ("README.md", "docs/results.md")
# At least one scene for each kind of body and each quantity of a state.
_SHOWN: Final = (
    ("euler/generic", "omega"),
    ("euler/full-tensor", "omega"),
    ("euler/tennis-racket", "omega"),
    ("euler/nesc-brick", "omega"),
    ("euler/nesc-brick", "attitude"),
    ("kirchhoff/screw", "impulse"),
    ("kirchhoff/general-body", "impulse"),
    ("kirchhoff/remus-100", "impulse"),
    ("kirchhoff/whole-motion", "impulse"),
    ("kirchhoff/whole-motion", "attitude"),
    ("kirchhoff/whole-motion", "centre"),
)


def requoted(folder: Path, verdicts: Sequence[Verdict]) -> dict[str, str]:
    """Return the pages beside ``folder`` that quote it, with new blocks, by their relative paths.

    Raises OSError for a page that cannot be read, and ValueError for a page with the first mark of a block
    and not the second.
    """
    place = folder.resolve()
    if place.name != _FOLDER:
        return {}
    blocks: dict[tuple[str, str], Callable[[], str]] = {(BEGIN, END): lambda: accuracy(verdicts)}
    if (study := CONTROLS.find(folder)) is not None:
        blocks[controls.BEGIN, controls.END] = lambda: controls.short(study)
    quoting = {}
    for name in _PAGES:
        page = place.parent / name
        text = page.read_text(encoding="utf-8") if page.is_file() else ""
        if any(begin in text for begin, _ in blocks):
            quoting[name] = _with_blocks(text, blocks)
    return quoting


def accuracy(verdicts: Iterable[Verdict]) -> str:
    """Return the block with the largest errors of chosen scenes by rung, between its marks."""
    return "\n\n".join([BEGIN, table(*chosen(verdicts)), END])


def chosen(verdicts: Iterable[Verdict]) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows of the chosen scenes: errors in u, and over attainable in brackets."""
    published = {(v.scene, v.quantity, v.rung): v for v in verdicts if v.solver == "taylor"}
    rungs = sorted({rung for _, _, rung in published}, key=place_of_rung)
    columns = ["scene", "what is compared", *(f"{r}:" for r in rungs)]
    return columns, [
        [code(scene), quantity, *(_cell(published.get((scene, quantity, rung))) for rung in rungs)]
        for scene, quantity in _SHOWN
    ]


def _cell(verdict: Verdict | None) -> str:
    error = in_roundoffs(verdict, verdict.max) if verdict else None
    if verdict is None or error is None or verdict.ratio is None:
        return "no number"
    return f"{error:.3g} u ({verdict.ratio:.2g})"


def _with_blocks(text: str, blocks: Mapping[tuple[str, str], Callable[[], str]]) -> str:
    for (begin, end), block in blocks.items():
        if begin in text:
            before, _, rest = text.partition(begin)
            _, _, after = rest.partition(end)
            if end not in rest:
                raise ValueError(f"expected {end} after {begin}, got a page without it")
            text = before + block() + after
    return text
