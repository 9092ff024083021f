"""How far a course has come, as a file: everything needed to go on as if it had never been left.

States and times are exact hexadecimal numbers. The file is replaced whole, after each piece of the
course; one that belongs to another question, or was made by other versions, is refused.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, Final

from taylor_verify.scenes.precision import hexadecimal
from taylor_verify.solvers.taylor.ensemble import Lane
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.solvers.values import exact
from taylor_verify.studies.stored import made_by

# Another format would be another number.
_FORMAT: Final = 1

# The state of every lane at one instant, and the steps that it took to there; None if it never came.
Sample = tuple[tuple[Fraction, ...], int] | None


class OfAnotherError(ValueError):
    """The checkpoint belongs to another question, or its numbers were made by another version."""


@dataclass(frozen=True)
class Progress:
    """``pieces`` of the course are done: there the lanes stand; ``samples`` holds the instants passed."""

    pieces: int
    lanes: tuple[Lane, ...]
    samples: tuple[tuple[Sample, ...], ...] = ()


def write(
    file: Path, question: Mapping[str, Any], versions: Mapping[str, str], progress: Progress
) -> None:
    """Put the checkpoint in place of an earlier one, whole or not at all. Raises OSError."""
    content = {
        **made_by("growth"),
        "format": _FORMAT,
        "question": dict(question),
        "versions": dict(versions),
        "pieces": progress.pieces,
        "lanes": [_of_lane(lane) for lane in progress.lanes],
        "samples": [[_of_sample(sample) for sample in row] for row in progress.samples],
    }
    text = json.dumps({**content, "checksum": _checksum(content)}, indent=0)
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_name(f".unfinished-{file.name}")
    with unfinished.open("w", encoding="utf-8", newline="\n") as stream:
        stream.write(text)
        stream.flush()
        # The new name must not be on the disk before what it names.
        os.fsync(stream.fileno())
    os.replace(unfinished, file)


def read(file: Path, question: Mapping[str, Any], versions: Mapping[str, str]) -> Progress | None:
    """What was written for this question; None where there is no file.

    Raises OfAnotherError for a checkpoint of something else, and ValueError for what is none.
    """
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        return None
    try:
        content = json.loads(text)
        checksum = content.pop("checksum")
        if checksum != _checksum(content):
            raise ValueError("the checksum is not that of the content")
        _belongs(content, question, versions, file)
        return Progress(
            int(content["pieces"]),
            tuple(_lane(lane) for lane in content["lanes"]),
            tuple(tuple(_sample(sample) for sample in row) for row in content["samples"]),
        )
    except OfAnotherError:
        raise
    except (AttributeError, LookupError, TypeError, ValueError) as fault:
        raise ValueError(
            f"expected a checkpoint of `publish growth`, got a fault, {fault}; remove the file to "
            f"begin anew @ {file}"
        ) from fault


def _belongs(
    content: Mapping[str, Any], question: Mapping[str, Any], versions: Mapping[str, str], file: Path
) -> None:
    """Raise for the first thing in which the checkpoint is another one."""
    asked = {"format": _FORMAT, **question, **versions}
    found = {"format": content["format"], **content["question"], **content["versions"]}
    for name in dict.fromkeys([*asked, *found]):
        if asked.get(name) != found.get(name):
            raise OfAnotherError(
                f"expected a checkpoint with {name} {asked.get(name)}, got {found.get(name)}; remove "
                f"the file to begin anew @ {file}"
            )


def _checksum(content: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _of_lane(lane: Lane) -> dict[str, Any]:
    return {
        "time": hexadecimal(lane.time),
        "state": _texts(lane.state),
        "fastest": lane.fastest.hex(),
        "steps": lane.steps,
        "outcome": lane.outcome.name,
    }


def _lane(found: Mapping[str, Any]) -> Lane:
    return Lane(
        _number(found["time"]),
        _numbers(found["state"]),
        float.fromhex(found["fastest"]),
        int(found["steps"]),
        Outcome[found["outcome"]],
    )


def _of_sample(sample: Sample) -> list[Any] | None:
    return None if sample is None else [_texts(sample[0]), sample[1]]


def _sample(found: Sequence[Any] | None) -> Sample:
    return None if found is None else (_numbers(found[0]), int(found[1]))


def _texts(numbers: Sequence[Fraction]) -> list[str]:
    return [hexadecimal(number) for number in numbers]


def _numbers(texts: Sequence[str]) -> tuple[Fraction, ...]:
    return tuple(_number(text) for text in texts)


def _number(text: str) -> Fraction:
    value = exact(text)
    if not isinstance(value, Fraction):
        raise ValueError(f"expected a finite number, got {text!r}")
    return value
