"""Columns that are asked for by their number, from 1, and files in which nothing else names them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from taylor_verify.records.faults import refusal
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.columns.request import Request
from taylor_verify.solvers.files.formats.column import Column


def by_number(
    columns: Sequence[Column], wanted: Request, scene: Scene | None, place: str
) -> Request:
    """Return the request with the names of columns in place of their numbers.

    Raises Refused for columns without a name of which none is asked for.
    """
    names = [column.name for column in columns]
    numbers = [str(k) for k in range(1, len(names) + 1)]
    if names and not wanted and names in (numbers, _elements(names)):
        mend = f"say which is which: --columns {','.join(_example(names, scene))}"
        got = f"numbers alone, in {len(names)} column{'s' * (len(names) > 1)}"
        raise refusal("a header line that names the columns", got, place, mend)
    by_text = dict(zip(numbers, names, strict=True)) | {name: name for name in names}
    return [(ours, by_text.get(theirs, theirs)) for ours, theirs in wanted]


def _elements(names: Sequence[str]) -> list[str]:
    """Return the names of the columns of one matrix, if the first is one whose name says nothing."""
    stem, bracket, _ = names[0].partition("[")
    means = Name(Column(names[0], ())).is_known
    return [f"{stem}[{k}]" for k in range(len(names))] if bracket and not means else []


def _example(names: Sequence[str], scene: Scene | None) -> Iterator[str]:
    groups = [group.columns for group in scene.groups] if scene else [("w1", "w2", "w3")]
    every = ["t", *(name for group in groups for name in group)]
    return (f"{ours}={theirs}" for ours, theirs in zip(every, names, strict=False))
