"""Checkpoint of a long measurement: all that is needed to continue it to the same last bit.

States and times are exact hexadecimal numbers. The file is replaced as a whole after each piece of the
measurement. A checkpoint of another question or of other versions is refused.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, Final

import msgspec

from taylor_verify.scenes.precision import hexadecimal
from taylor_verify.solvers.taylor.ensemble import Lane
from taylor_verify.solvers.values import exact
from taylor_verify_reports.studies.stored import made_by

# The number of the file format.
_FORMAT: Final = 2

# The state of one lane at one instant and its steps so far; None for a lane that ended before.
Sample = tuple[tuple[Fraction, ...], int] | None


class OfAnotherError(ValueError):
    """The checkpoint belongs to another question, or its numbers were made by another version."""


@dataclass(frozen=True)
class Progress:
    """The lanes after the first ``pieces`` pieces of a measurement.

    ``samples[k][i]`` is lane i at instant k, in its problem's own units, for the instants so far.
    """

    pieces: int
    lanes: tuple[Lane, ...]
    samples: tuple[tuple[Sample, ...], ...] = ()


def write(
    file: Path, question: Mapping[str, Any], versions: Mapping[str, str], progress: Progress
) -> None:
    """Store a checkpoint in place of an earlier one, entirely or not at all. Raises OSError."""
    content = {
        **made_by("growth"),
        "format": _FORMAT,
        "question": dict(question),
        "versions": dict(versions),
        **msgspec.to_builtins(progress, enc_hook=hexadecimal),
    }
    text = json.dumps({**content, "checksum": _checksum(content)}, indent=0)
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_name(f".unfinished-{file.name}")
    with unfinished.open("w", encoding="utf-8", newline="\n") as stream:
        stream.write(text)
        stream.flush()
        # The content must be on the disk before the file gets its name.
        os.fsync(stream.fileno())
    os.replace(unfinished, file)


def read(file: Path, question: Mapping[str, Any], versions: Mapping[str, str]) -> Progress | None:
    """Return the checkpoint of this question; None if there is no file.

    Raises OSError for a file that cannot be read, OfAnotherError for a checkpoint of another question
    or other versions, and ValueError for any other content.
    """
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        return None
    try:
        content = json.loads(text)
        if content.pop("checksum") != _checksum(content):
            raise ValueError("the checksum is not that of the content")
        _check_origin(content, question, versions, file)
        return msgspec.convert(content, Progress, dec_hook=_number)
    except OfAnotherError:
        raise
    except (AttributeError, LookupError, TypeError, ValueError) as fault:
        raise ValueError(
            f"expected a checkpoint of `publish growth`, got a fault, {fault}; remove the file to "
            f"begin anew @ {file}"
        ) from fault


def _check_origin(
    content: Mapping[str, Any], question: Mapping[str, Any], versions: Mapping[str, str], file: Path
) -> None:
    """Raise an OfAnotherError that names the first difference, if there is one."""
    asked = {"format": _FORMAT, **question, **versions}
    stored = {"format": content["format"], **content["question"], **content["versions"]}
    for name in dict.fromkeys([*asked, *stored]):
        if asked.get(name) != stored.get(name):
            raise OfAnotherError(
                f"expected a checkpoint with {name} {asked.get(name)}, got {stored.get(name)}; remove "
                f"the file to begin anew @ {file}"
            )


def _checksum(content: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _number(kind: type, text: Any) -> Any:
    """Return the exact number of a text for a field that holds a number."""
    value = exact(text)
    if not isinstance(value, kind):
        raise ValueError(f"expected a finite number, got {text!r}")
    return value
