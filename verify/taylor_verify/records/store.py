"""Verdicts and records as JSON files; the time and the machine of each run are stored separately.

    verdicts.json   every verdict, one a line, and the digest of each scene's text; the same on any
                    machine that computes the same;
                    shifts of time of failed gates alone: a passed one has them of its roundings
    verdicts.sha256 its sum, which is asked before a page or a comparison is made of them
    timings.json    seconds of every run; Python, processor and command of every machine
    records/        one file a run: the equations built and every sample's error; of which verdicts
                    they are, verdicts.sha256 says

Floats are written so that they read back to the last bit; one that is not finite is null.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, Final

from taylor_verify.records import file_names
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.json_text import DOCUMENT, complete, read
from taylor_verify.records.record import Record
from taylor_verify.records.regular_file import bounded_bytes
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.records.runs import Run, runs
from taylor_verify.records.soundness import check_rows, check_runs
from taylor_verify.records.status import Status
from taylor_verify.records.sums import line
from taylor_verify.records.verdict import Verdict

FOLDER: Final = "data"
VERDICTS: Final = "verdicts.json"
TIMINGS: Final = "timings.json"
SUM: Final = "verdicts.sha256"
RECORDS: Final = "records"
STAMP: Final = f"{RECORDS}/verdicts.sha256"

_MADE_BY = {"made_by": "taylor-verify run; do not edit"}
# Fields on which no number depends: they may differ where verdicts.json may not.
_MACHINE = ("processor", "command")
_SHIFT = ("time_shift", "residual", "shift", "trend", "remains")

# The seconds and the machine of each run.
_Timed = Mapping[tuple[str, str, str, str], tuple[float | None, Mapping[str, Any]]]

_ENCODER: Final = json.JSONEncoder(allow_nan=False, ensure_ascii=False)
# A row is for programs, and a large file has thousands of them.
_ROW_ENCODER: Final = json.JSONEncoder(allow_nan=False, ensure_ascii=False, separators=(",", ":"))


def write(folder: Path, verdicts: Iterable[Verdict], records: Iterable[Record]) -> tuple[Path, ...]:
    """Write ``folder``/data, in place of an earlier one, and return the files written.

    Raises OSError if that cannot be done, and ValueError for verdicts of unlike versions or two
    unlike records of one run; the earlier data then stay as they are.
    """
    ordered_runs = runs(verdicts)
    data = folder / FOLDER
    ordered = [verdict for run in ordered_runs for verdict in run.verdicts]
    rows = [row(verdict, apart=("scene",)) for verdict in ordered]
    same = {"versions": versions(ordered), "scenes": _digests(ordered)}
    text = laid_out({**_MADE_BY, **same, "verdicts": rows})
    # The verdicts are written last, so that the files they refer to are already there.
    texts: dict[str, str | Iterator[str]] = {
        **_record_texts(records),
        TIMINGS: laid_out({**_MADE_BY, **_timings(ordered_runs)}),
        STAMP: line(text.encode(), f"../{VERDICTS}"),
        SUM: line(text.encode(), VERDICTS),
        VERDICTS: text,
    }
    return replace_files(data, texts, stale=_own_records(data))


def add_records(folder: Path, records: Iterable[Record]) -> tuple[Path, ...]:
    """Write records beside the verdicts that ``folder``/data has, and return the files written.

    Records of these verdicts stay, records of others are removed. Raises OSError and ValueError as
    `write` does.
    """
    data = folder / FOLDER
    stamp = {STAMP: line(_stored_bytes(data / VERDICTS), f"../{VERDICTS}")}
    # Before the new stamp is there, so that an interrupt leaves none that it would not fit.
    for record in () if has_own_records(folder) else _own_records(data):
        record.unlink(missing_ok=True)
    return replace_files(data, {**_record_texts(records), **stamp})


def has_own_records(folder: Path) -> bool:
    """Return True unless the records in ``folder``/data say that they are those of other verdicts."""
    data = folder / FOLDER
    return not (data / STAMP).exists() or _agrees(data, STAMP, f"../{VERDICTS}")


def are_edited(folder: Path) -> bool | None:
    """Return True if the verdicts in ``folder``/data are not those that their SHA-256 was made of.

    None where it is gone. Raises OSError for verdicts that cannot be read.
    """
    data = folder / FOLDER
    if (data / SUM).exists():
        return not _agrees(data, SUM, VERDICTS)
    return None if (data / VERDICTS).exists() else False


def _agrees(data: Path, stated: str, named: str) -> bool:
    return _stored_bytes(data / stated) == line(_stored_bytes(data / VERDICTS), named).encode()


def record_name(scene: str, solver: str, rung: str) -> str:
    """Return the path below ``folder``/data of the record of a run."""
    stem = f"{file_names.of_scene(scene)}.{file_names.of_solver(solver)}"
    return f"{RECORDS}/{stem}.{rung}.json"


def load(folder: Path) -> tuple[Verdict, ...]:
    """Return the verdicts of ``folder``/data as they were written, in reading order.

    A number that was not finite is None. Raises OSError for files that cannot be read and
    ValueError for files that hold something else. Timings may be missing.
    """
    file = folder / FOLDER / VERDICTS
    stored, timed = read(file, _Verdicts), _timed(folder / FOLDER / TIMINGS)
    rows = (_as_made(row, stored, timed or {}) for row in stored.verdicts)
    placed = {f"verdicts[{k}]": row for k, row in enumerate(rows)}
    try:
        check_rows(placed)
        if timed is not None:
            check_runs(placed, timed)
    except ValueError as error:
        raise ValueError(f"{error} @ {file}") from error
    return tuple(placed.values())


@dataclass(frozen=True)
class _Verdicts:
    """The document of verdicts, with what many of them have in common."""

    versions: dict[str, str]
    verdicts: tuple[Verdict, ...]
    scenes: dict[str, str] = field(default_factory=dict)


def _as_made(row: Verdict, stored: _Verdicts, timed: _Timed) -> Verdict:
    """Return a stored row as it was made: with its seconds, machine, versions and digest."""
    seconds, machine = timed.get(row.run, (None, {}))
    python = {"python": machine["python"]} if "python" in machine else {}
    all_versions = {**python, **stored.versions}
    provenance: dict[str, Any] = {"versions": all_versions} if all_versions else {}
    provenance |= {name: value for name, value in machine.items() if name != "python"}
    whole = replace(row, provenance=provenance | row.provenance, seconds=seconds)
    return with_digest(whole, stored.scenes)


def with_digest(verdict: Verdict, digests: Mapping[str, str]) -> Verdict:
    """Return a stored verdict with the digest of its scene, which a document has once for each scene."""
    if "scene" in verdict.provenance or verdict.scene not in digests:
        return verdict
    provenance = {**verdict.provenance, "scene": digests[verdict.scene]}
    return replace(verdict, provenance=provenance)


def _digests(verdicts: Iterable[Verdict]) -> dict[str, str]:
    """Return the digest of each scene's text. Raises ValueError for two of one scene."""
    digests: dict[str, str] = {}
    for verdict in verdicts:
        if (digest := verdict.provenance.get("scene")) is None:
            continue
        if digests.setdefault(verdict.scene, digest) != digest:
            raise ValueError(f"expected one text of {verdict.scene}, got two")
    return digests


def versions(verdicts: Iterable[Verdict]) -> dict[str, str]:
    """Return the versions all verdicts were made with; not Python's, on which no number depends."""
    sets = [{**verdict.provenance.get("versions", {})} for verdict in verdicts]
    for own in sets:
        own.pop("python", None)
        if own != sets[0]:
            raise ValueError(f"expected one set of versions, got {sets[0]} and {own}")
    return sets[0] if sets else {}


# Writing.


# Made of the other numbers of a row, or of the scene.
_DERIVED = ("because", "digits", "sentence", "until")
# Most rows have none of these.
_SELDOM = ("tolerance", "since", "change", "error_kind", "exponent")


def row(verdict: Verdict, apart: Collection[str] = ()) -> dict[str, Any]:
    """Return a verdict as it is stored, without numbers that depend on the run or the machine.

    ``apart`` are keys of its provenance that the document has once for many verdicts.
    """
    stored = verdict.row()
    del stored["seconds"], stored["provenance"]
    left_out = {*_DERIVED, *(name for name in _SELDOM if stored[name] is None)}
    if verdict.verdict is not Status.FAIL:
        # The sign of the shift by roundings differs on every machine.
        left_out |= {*_SHIFT, "change"}
    if verdict.error_kind is ErrorKind.ROUNDOFF:
        left_out.add("error_kind")
    for name in left_out:
        del stored[name]
    left_out = {"versions", *_MACHINE, *apart}
    own = {key: value for key, value in verdict.provenance.items() if key not in left_out}
    return {**stored, "provenance": own} if own else stored


def _timings(ordered_runs: Iterable[Run]) -> dict[str, Any]:
    """Return the seconds of each run, with the place of its machine in a list of them."""
    machines: list[dict[str, Any]] = []
    timings = []
    for run in ordered_runs:
        verdict = run.verdicts[0]
        own = machine(verdict)
        if own not in machines:
            machines.append(own)
        key = {name: getattr(run, name) for name in ("scene", "solver", "setting", "rung")}
        timings.append({**key, "seconds": verdict.seconds, "machine": machines.index(own)})
    return {"machines": machines, "timings": timings}


def machine(verdict: Verdict) -> dict[str, Any]:
    """Return the machine of a verdict, as far as it says so: Python, processor and command."""
    given = {**verdict.provenance.get("versions", {}), **verdict.provenance}
    return {name: given[name] for name in ("python", *_MACHINE) if name in given}


def _record_texts(records: Iterable[Record]) -> dict[str, Iterator[str]]:
    """Return the text of each record, which is made while it is written."""
    by_name: dict[str, Record] = {}
    for record in records:
        name = record_name(record.scene, record.solver, record.rung)
        first = by_name.setdefault(name, record)
        if first is not record and _text(first) != _text(record):
            raise ValueError(f"expected one record a run, got two unlike ones @ {name}")
    return {name: map(_text, [record]) for name, record in by_name.items()}


def _text(record: Record) -> str:
    return laid_out({**_MADE_BY, **record.document()})


def _own_records(data: Path) -> list[Path]:
    """Return the records of an earlier run: files that name their maker, and no others."""
    maker = laid_out(_MADE_BY).removesuffix("}\n") + ","
    return [file for file in (data / RECORDS).glob("*.json") if first_line(file) == maker]


def laid_out(document: Mapping[str, Any]) -> str:
    """Return JSON with a line for every key and for every row of a list of rows."""
    members = (f"{_ENCODER.encode(key)}: {_value(value)}" for key, value in document.items())
    return "{" + ",\n ".join(members) + "}\n"


def _value(value: Any) -> str:
    rows = value if isinstance(value, (list, tuple)) else ()
    if rows and all(isinstance(row, dict) for row in rows):
        lines = ",\n  ".join(_encoded(row, _ROW_ENCODER) for row in rows)
        return f"[\n  {lines}\n ]"
    return _encoded(value, _ENCODER)


def _encoded(value: Any, encoder: json.JSONEncoder) -> str:
    try:
        return encoder.encode(value)
    except ValueError:
        return encoder.encode(complete(value))


# Reading.

_stored_bytes = partial(bounded_bytes, expected="a stored document", most=DOCUMENT)


def read_document(file: Path) -> dict[str, Any]:
    """Return the JSON object in a file; ValueError, with the file, for anything else."""
    return read(file, dict[str, Any])


@dataclass(frozen=True)
class _Timing:
    scene: str
    solver: str
    setting: str
    rung: str
    seconds: float | None
    machine: int


@dataclass(frozen=True)
class _Timings:
    """The document of timings: each run's seconds, and the place of its machine in a list of them."""

    machines: tuple[dict[str, Any], ...]
    timings: tuple[_Timing, ...]


def _timed(file: Path) -> _Timed | None:
    """Return each run's seconds and machine; None where there is no such file."""
    if not file.exists():
        return None
    stored, timed = read(file, _Timings), {}
    for place, timing in enumerate(stored.timings):
        if not 0 <= timing.machine < len(stored.machines):
            expected = f"expected one of {len(stored.machines)} machines, got {timing.machine}"
            raise ValueError(f"{expected} @ timings[{place}].machine @ {file}")
        run = timing.scene, timing.solver, timing.setting, timing.rung
        timed[run] = timing.seconds, stored.machines[timing.machine]
    return timed


@contextmanager
def expecting(what: str, file: Path) -> Iterator[None]:
    """Report whatever goes wrong in reading stored rows as a ValueError that names the file."""
    try:
        yield
    except (AttributeError, LookupError, TypeError, ValueError) as fault:
        description = f"{type(fault).__name__}: {fault}"
        raise ValueError(f"expected {what}, got a fault, {description} @ {file}") from fault
