"""Verdicts as GitHub annotations, which are lines in the output of a step.

    ::error title=...::...     fail, a regression, and a call that came to nothing
    ::warning title=...::...   undecided, vacuous, refused: the step is red by its exit status
    ::notice title=...::...    unavailable, and vacuous as --partial asks

The file of a scene is named, so that GitHub shows the line beside it. GitHub keeps the first ten lines of
each level and step and drops the rest silently, so the tenth line counts the rest.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.case import Case, Remark, cases

_LEVELS: Final = {
    Status.FAIL: "error",
    Status.UNDECIDED: "warning",
    Status.VACUOUS: "warning",
    Status.REFUSED: "warning",
}
_HARMLESS: Final = "notice"
_MOST: Final = 10


def annotation_lines(
    verdicts: Iterable[Verdict], remarks: Iterable[Remark] = (), by_remarks: bool = False
) -> list[str]:
    """Return the lines, errors first; none if every row is a pass. ``by_remarks`` is as in `cases`."""
    levels: dict[str, list[Case]] = {level: [] for level in (*_LEVELS.values(), _HARMLESS)}
    for case in cases(verdicts, remarks, by_remarks):
        if case.counted is not Status.PASS:
            levels[_HARMLESS if case.is_harmless else _LEVELS[case.counted]].append(case)
    return [line for level, level_cases in levels.items() for line in _of_level(level, level_cases)]


def fault_line(lines: Iterable[str]) -> str:
    """Return the line on a call that came to nothing, for its faults."""
    return _line("error", {"title": "taylor-verify was called with faults"}, "\n".join(lines))


def _of_level(level: str, level_cases: list[Case]) -> Iterator[str]:
    shown = level_cases if len(level_cases) <= _MOST else level_cases[: _MOST - 1]
    for case in shown:
        place = {"file": case.scene, "line": "1"} if case.scene.endswith(".toml") else {}
        yield _line(level, {**place, "title": case.title}, case.text)
    if rest := len(level_cases) - len(shown):
        text = "GitHub shows ten of a kind; the step summary and the JUnit file have all"
        yield _line(level, {"title": f"and {rest} more"}, text)


def _line(level: str, properties: dict[str, str], text: str) -> str:
    given = ",".join(f"{name}={_property(value)}" for name, value in properties.items())
    return f"::{level} {given}::{_data(text)}"


def _data(text: str) -> str:
    """Return an escaped text, so that a line of a program's stderr is never read as a command."""
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
