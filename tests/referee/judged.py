"""Drawn questions, what the command answers, and what the referee finds wrong in it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

from referee.command import Answer, Command
from referee.comparison import Fault, faults
from referee.draws import Draw, draw


class Judged(NamedTuple):
    """A question and the faults of its answer, or the reason for which there is none."""

    question: Draw
    faults: list[Fault]
    refusal: str | None

    def __str__(self) -> str:
        return "\n".join([str(self.question), *map(str, self.faults), self.refusal or ""])


def judged(command: Command, numbers: Iterable[int]) -> Iterator[Judged]:
    """Yield the judgement of each drawn question. The command answers one while another is judged."""
    questions = [draw(number) for number in numbers]
    pool = ThreadPoolExecutor(1)
    try:
        answers = pool.map(lambda question: command.exact(*question.asked), questions)
        for question, answer in zip(questions, answers, strict=True):
            yield judgement(question, answer)
    finally:
        pool.shutdown(cancel_futures=True)


def judgement(question: Draw, answer: Answer) -> Judged:
    """Return what is wrong in an answer; a refusal is not compared."""
    if answer.refusal:
        return Judged(question, [], answer.refusal)
    return Judged(question, faults(*question.asked, answer.document), None)
