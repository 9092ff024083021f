"""The file of vectors: a line for each question and for each wrong answer."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict
from functools import partial
from typing import Any, Final

from taylor_verify.batch.work import run_all
from taylor_verify_reports.studies.study import Progress
from taylor_verify_reports.studies.vectors.questions import answered, questions
from taylor_verify_reports.studies.vectors.wrong_answers import COUNT, TOLERANCE, wrong_answer

FILE: Final = "vectors.json"
_MADE_BY: Final = "taylor-verify publish vectors; do not edit"


def written(seed: int, progress: Progress) -> tuple[dict[str, str], list[str]]:
    """Return the file, and a message for each sentence of `check` that was false."""
    asked = questions(seed)
    finished = progress.counting(len(asked) + COUNT)
    right = run_all(answered, asked, ended=lambda each, _: finished(each.name))
    work = partial(wrong_answer, seed)
    made = run_all(work, range(COUNT), ended=lambda number, _: finished(f"wrong answer {number}"))
    wrong = [asdict(answer) for answer, _ in made if answer is not None]
    head = {"made_by": _MADE_BY, "seed": seed, "tolerance": TOLERANCE}
    text = _text(head, {"questions": right, "wrong": wrong})
    return {FILE: text}, [f"false: {sentence}" for _, false in made for sentence in false]


def _text(head: dict[str, Any], lists: dict[str, Iterable[Any]]) -> str:
    """Return a JSON document with a line for each entry of its lists."""
    parts = [f"{json.dumps(name)}: {json.dumps(value)}" for name, value in head.items()]
    parts += [f"{json.dumps(name)}: [\n{_lines(entries)}\n]" for name, entries in lists.items()]
    return "{" + ",\n".join(parts) + "}\n"


def _lines(entries: Iterable[Any]) -> str:
    return ",\n".join(json.dumps(entry, separators=(",", ":")) for entry in entries)
