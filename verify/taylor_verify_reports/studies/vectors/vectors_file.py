"""The study of vectors: questions with right answers, and wrong answers, a line each in one file.

Their schema and the readers in four languages are written by hand where they are published.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.replacement import replace_files
from taylor_verify_reports.studies.study import Measured, Progress, Study

FOLDER: Final = "vectors"
FILE: Final = "vectors.json"
_SEED: Final = 48
_MADE_BY: Final = "taylor-verify publish vectors; do not edit"


def _measure(folder: Path, progress: Progress) -> Measured:
    """Write the file; a message tells each sentence of `check` that was false."""
    from taylor_verify.batch.work import run_all
    from taylor_verify_reports.studies.vectors.questions import answered, questions
    from taylor_verify_reports.studies.vectors.wrong_answers import COUNT, TOLERANCE, wrong_answer

    asked = questions(_SEED)
    finished = progress.counting(len(asked) + COUNT)
    right = run_all(answered, asked, ended=lambda each, _: finished(each.name))
    work = partial(wrong_answer, _SEED)
    made = run_all(work, range(COUNT), ended=lambda number, _: finished(f"wrong answer {number}"))
    wrong = [asdict(answer) for answer, _ in made if answer is not None]
    head = {"made_by": _MADE_BY, "seed": _SEED, "tolerance": TOLERANCE}
    lists = ",\n".join(_lines(*each) for each in (("questions", right), ("wrong", wrong)))
    start = json.dumps(head, separators=(",\n", ": ")).removesuffix("}")
    text = f"{start},\n{lists}}}\n"
    written = replace_files(folder, {f"{FOLDER}/{FILE}": text})
    return Measured(written, [f"false: {sentence}" for _, false in made for sentence in false])


def _lines(name: str, entries: list[Any]) -> str:
    """Return a list of a JSON document, a line for each entry."""
    lines = ",\n".join(json.dumps(entry, separators=(",", ":")) for entry in entries)
    return f"{json.dumps(name)}: [\n{lines}\n]"


STUDY: Final[Study[None]] = Study(
    name="vectors",
    title="questions with right and wrong answers, to test simulators and judges with",
    duration="half an hour",
    measure=_measure,
    place=f"{FOLDER}/schema.json",
    needs_heyoka=False,
)
