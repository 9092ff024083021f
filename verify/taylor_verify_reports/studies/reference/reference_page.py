"""The study of the reference: the exact trajectory of every scene of the standard set, in digits.

NAME.csv      a heading line and a row for every sample time, in decimal text
loads.csv     the same of all scenes under loads, with the scene as the first column
NAME.json     the same columns as arrays of strings, and the scene; no page links to it, because it
              is not in the repository
README.md     columns, conventions, tolerances
example.cpp   a program that compares a trajectory with a reference
example.rs    a program that integrates a body and compares its motion with a reference
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any, Final

from taylor_verify.records import file_names
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.words.markdown import code, table
from taylor_verify.words.page_parts import MADE_BY
from taylor_verify_reports.studies.stored import SceneDocuments, documents
from taylor_verify_reports.studies.study import Bulk, Measured, Progress, Published, Study

FOLDER: Final = "reference"
# The scenes of a folder that have one sheet together, and its name.
_SHARED: Final = {"loads": "loads.csv"}
EXAMPLES: Final = ("example.cpp", "example.rs")
_TEMPLATES: Final = Path(__file__).with_name("templates")
_SHEET: Final = re.compile(r"\[csv\]\(([^()/]+\.csv)\)")

Document = Mapping[str, Any]
"""Row of a scene: ``columns`` (a list of decimal texts by name), and the other keys of its JSON."""


def _flat(document: Document) -> Document:
    """Return a document with its columns as keys of their own."""
    others = {name: value for name, value in document.items() if name != "columns"}
    return {**others, **document["columns"]}


TRAJECTORIES: Final = SceneDocuments(
    FOLDER, "taylor-verify publish --reference; do not edit", form=_flat
)


def write(folder: Path, documents: Sequence[Document]) -> list[Path]:
    """Write ``folder``/reference, in place of an earlier one, and return the files written.

    Files of scenes that no longer exist are removed; files of another maker stay. Raises OSError; the
    folder then stays as it was.
    """
    examples = {name: (_TEMPLATES / name).read_text(encoding="utf-8") for name in EXAMPLES}
    beside = {
        **_sheets(documents),
        **examples,
        "README.md": _readme(documents, examples),
    }
    texts = TRAJECTORIES.texts(documents)
    texts |= {f"{FOLDER}/{name}": text for name, text in beside.items()}
    stale = [*TRAJECTORIES.own(folder), *_own_sheets(folder / FOLDER)]
    return list(replace_files(folder, texts, stale=stale))


def sheet_of(scene: str) -> str:
    """Return the name of the sheet that has the rows of a scene."""
    return _SHARED.get(scene.split("/")[0], f"{file_names.of_scene(scene)}.csv")


def _sheets(documents: Sequence[Document]) -> dict[str, str]:
    """Return the text of each sheet, by its name."""
    by_name: dict[str, list[Document]] = {}
    for document in documents:
        by_name.setdefault(sheet_of(document["scene"]), []).append(document)
    return {
        name: _sheet(_joined(rows) if name in _SHARED.values() else rows[0]["columns"])
        for name, rows in by_name.items()
    }


def _joined(documents: Sequence[Document]) -> dict[str, list[str]]:
    """Return the columns of several scenes one below the other, empty where a scene has none.

    The columns of the model euler come first, and the error bound last.
    """
    written = {name for each in documents for name in each["columns"]}
    usual = ["t", *chain(*COLUMNS.values())]
    own = sorted(written.difference(usual, ["radius"]))
    names = [name for name in (*usual, *own, "radius") if name in written]
    joined: dict[str, list[str]] = {name: [] for name in ("scene", *names)}
    for document in documents:
        columns = document["columns"]
        blank = [""] * len(columns["t"])
        joined["scene"] += [document["scene"]] * len(blank)
        for name in names:
            joined[name] += columns.get(name, blank)
    return joined


def _sheet(columns: Mapping[str, Sequence[str]]) -> str:
    """Return columns as CSV, without quotation marks and comments."""
    lines = [columns.keys(), *zip(*columns.values(), strict=True)]
    return "".join(",".join(cells) + "\n" for cells in lines)


def _readme(documents: Iterable[Document], examples: Mapping[str, str]) -> str:
    columns = ["scene", "regime", "columns", "rows:", "file"]
    text = (_TEMPLATES / "reference.md").read_text(encoding="utf-8")
    filled = text.replace("{{scenes}}", table(columns, [_row(document) for document in documents]))
    for name, program in examples.items():
        # The page quotes the programs from their files.
        filled = filled.replace(f"{{{{{name}}}}}", program.rstrip())
    return f"{MADE_BY}\n{filled}"


def _row(document: Document) -> list[str]:
    columns = document["columns"]
    vectors = dict.fromkeys(name[0] for name in columns if name not in {"t", "radius"})
    return [
        code(document["scene"]),
        document["regime"],
        " ".join(code(vector) for vector in vectors),
        str(len(columns["t"])),
        f"[csv]({sheet_of(document['scene'])})",
    ]


def _own_sheets(target: Path) -> list[Path]:
    """Return the CSV files that the page made by this program links to."""
    page = target / "README.md"
    if not page.exists() or first_line(page) != MADE_BY:
        return []
    names = dict.fromkeys(_SHEET.findall(page.read_text(encoding="utf-8")))
    return [target / name for name in names]


# The study.


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify.scenes.library import names
    from taylor_verify_reports.studies.reference.exact_table import reference

    return Measured(write(folder, documents(reference, names(), progress)))


def _lacking(report: Published) -> tuple[str, ...]:
    """Return the scenes with a sheet whose JSON is missing or outdated."""
    target = report.folder / FOLDER
    return tuple(
        scene for scene in report.outdated_scenes(FOLDER) if (target / sheet_of(scene)).exists()
    )


def _add(folder: Path, scenes: Sequence[str], progress: Progress) -> list[Path]:
    from taylor_verify_reports.studies.reference.exact_table import reference

    return TRAJECTORIES.add_made(folder, reference, scenes, progress)


STUDY: Final = Study[None](
    name="reference",
    title="exact motions in digits, to test other programs with",
    duration="a minute, all cores",
    measure=_measure,
    place=f"{FOLDER}/README.md",
    needs_heyoka=False,
    bulk=(
        Bulk(
            what="exact trajectories as JSON",
            patterns=(f"{FOLDER}/*.json",),
            lacking=_lacking,
            make=_add,
        ),
    ),
)
