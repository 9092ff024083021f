"""The study of vectors: questions with right answers, and wrong answers.

Their schema and the readers in four languages are written by hand where they are published.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify.records.replacement import replace_files
from taylor_verify_reports.studies.study import Measured, Progress, Study

FOLDER: Final = "vectors"
_SEED: Final = 48


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify_reports.studies.vectors.vectors_document import written

    texts, messages = written(_SEED, progress)
    named = {f"{FOLDER}/{name}": text for name, text in texts.items()}
    return Measured(replace_files(folder, named), messages)


STUDY: Final[Study[None]] = Study(
    name="vectors",
    title="questions with right and wrong answers, to test simulators and judges with",
    duration="half an hour",
    measure=_measure,
    place=f"{FOLDER}/schema.json",
    needs_heyoka=False,
)
