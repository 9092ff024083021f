"""The study of vectors: questions with right answers, wrong answers, and readers in four languages."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify.records.replacement import replace_files
from taylor_verify_reports.studies.study import Measured, Progress, Study

FOLDER: Final = "vectors"
_SEED: Final = 48
BESIDE: Final = Path(__file__).with_name("published")


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify_reports.studies.vectors.vectors_document import written

    texts, messages = written(_SEED, progress)
    beside = {file.name: file.read_text(encoding="utf-8") for file in sorted(BESIDE.iterdir())}
    named = {f"{FOLDER}/{name}": text for name, text in (texts | beside).items()}
    return Measured(replace_files(folder, named), messages)


STUDY: Final[Study[None]] = Study(
    name="vectors",
    title="questions with right and wrong answers, to test simulators and judges with",
    duration="half an hour",
    measure=_measure,
    place=f"{FOLDER}/schema.json",
    needs_heyoka=False,
)
