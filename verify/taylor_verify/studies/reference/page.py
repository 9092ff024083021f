"""The exact trajectories as CSV and JSON files, with a page that says how to read them.

NAME.csv      a heading line and a row for every sample time, in decimal text
NAME.json     the same columns as arrays of strings, and the question they answer; no page links to
              it, for the repository does not hold it
README.md     columns, conventions, tolerances
example.cpp   a program that compares a trajectory with a reference
example.rs    a program that integrates a body and compares itself with a reference
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from taylor_verify.publish.markdown import code, table
from taylor_verify.publish.page import MADE_BY
from taylor_verify.records import file_names
from taylor_verify.records.replacement import first_line, replace_files

FOLDER: Final = "reference"

_MADE_BY: Final = {"made_by": "taylor-verify publish --reference; do not edit"}
EXAMPLES: Final = ("example.cpp", "example.rs")
_TEMPLATES: Final = Path(__file__).with_name("templates")
_SHEET: Final = re.compile(r"\[csv\]\(([^()/]+\.csv)\)")
_ROUTES: Final = {"mpmath": "closed form", "taylor": "Taylor"}

Document = Mapping[str, Any]
"""One scene: ``columns`` (name to decimal texts, one a row) and what else its JSON shall hold."""


def write(folder: Path | str, documents: Sequence[Document]) -> list[Path]:
    """Write ``folder``/reference, in place of an earlier one, and return the files written.

    Files of scenes that are no longer there are removed, other people's files are left alone.
    Raises OSError; what the folder held then stays as it was.
    """
    texts = _json_texts(documents)
    for document in documents:
        texts[f"{_stem(document)}.csv"] = _sheet(document["columns"])
    examples = {name: (_TEMPLATES / name).read_text(encoding="utf-8") for name in EXAMPLES}
    texts |= examples
    texts["README.md"] = _readme(documents, examples)
    target = Path(folder) / FOLDER
    return list(replace_files(target, texts, stale=_own_files(target)))


def add_json(folder: Path | str, documents: Iterable[Document]) -> list[Path]:
    """Write the JSON files alone, beside what is there, and return them. Raises OSError."""
    return list(replace_files(Path(folder) / FOLDER, _json_texts(documents)))


def _json_texts(documents: Iterable[Document]) -> dict[str, str]:
    return {f"{_stem(document)}.json": _laid_out(document) for document in documents}


def _stem(document: Document) -> str:
    return file_names.of_scene(str(document["scene"]))


def _sheet(columns: Mapping[str, Sequence[str]]) -> str:
    """Nothing in it needs a quotation mark, and no line is a comment: any reader takes it."""
    lines = [columns.keys(), *zip(*columns.values(), strict=True)]
    return "".join(",".join(cells) + "\n" for cells in lines)


def _laid_out(document: Document) -> str:
    """JSON with a line for every key; the columns stand beside the other keys."""
    keys = {**_MADE_BY, **document, **document["columns"]}
    del keys["columns"]
    lines = (f"{json.dumps(k)}: {json.dumps(v, ensure_ascii=False)}" for k, v in keys.items())
    return "{" + ",\n ".join(lines) + "}\n"


def _readme(documents: Iterable[Document], examples: Mapping[str, str]) -> str:
    columns = ["scene", "regime", "route", "columns", "rows:", "file"]
    text = (_TEMPLATES / "reference.md").read_text(encoding="utf-8")
    filled = text.replace("{{scenes}}", table(columns, [_row(found) for found in documents]))
    for name, program in examples.items():
        # A program is the same as in its file, and written once.
        filled = filled.replace(f"{{{{{name}}}}}", program.rstrip())
    return f"{MADE_BY}\n{filled}"


def _row(document: Document) -> list[str]:
    columns, stem = document["columns"], _stem(document)
    vectors = dict.fromkeys(name[0] for name in columns if name not in {"t", "radius"})
    return [
        code(document["scene"]),
        document["regime"],
        _ROUTES.get(document["route"], document["route"]),
        " ".join(code(vector) for vector in vectors),
        str(len(columns["t"])),
        f"[csv]({stem}.csv)",
    ]


def _own_files(target: Path) -> list[Path]:
    """The JSON files that name us as their maker, and the CSV files that our page links to."""
    maker = "{" + json.dumps(_MADE_BY)[1:-1] + ","
    own = [file for file in target.glob("*.json") if first_line(file) == maker]
    page = target / "README.md"
    if page.exists() and first_line(page) == MADE_BY:
        own += [target / name for name in _SHEET.findall(page.read_text(encoding="utf-8"))]
    return own
