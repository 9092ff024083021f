"""Two columns of a CSV file in the folder of a scene, as exact numbers."""

from __future__ import annotations

import csv
from fractions import Fraction
from pathlib import Path
from typing import Final

from taylor_verify.numbers.tensors import Vector
from taylor_verify.records.faults import Refused
from taylor_verify.records.limit import Limit
from taylor_verify.records.regular_file import read_bytes
from taylor_verify.scenes.reading.table import Table, complete, exact_number

_MOST_BYTES: Final = Limit(2**22, "bytes", "ten thousand rows of many columns")


def columns(
    table: Table, folder: Path | None, name: str, time: str, value: str, most_rows: int
) -> tuple[Vector, Vector] | None:
    """Return two columns by their names in the first row of the file; None after a fault."""
    path = _inside(table, folder, name)
    if path is None:
        return None
    try:
        text = read_bytes(path, "a CSV file", _MOST_BYTES).decode("utf-8-sig")
        rows = list(csv.reader(text.splitlines(), strict=True))
    except Refused as refused:
        table.faults.lines.extend(refused.faults)
        return None
    except (UnicodeDecodeError, csv.Error) as error:
        table.fault("a CSV file in UTF-8", str(error), "file")
        return None
    head = [cell.strip() for cell in rows[0]] if rows else []
    known = True
    for key, column in (("time", time), ("column", value)):
        if head.count(column) != 1:
            twice = f"`{column[:40]}` in {head.count(column)} columns"
            got = twice if column in head else column[:40]
            table.fault(f"one of the columns {', '.join(head)[:200]}", got, key)
            known = False
    if not known:
        return None
    if not 2 <= len(rows) <= most_rows + 1:
        table.fault(f"1 to {most_rows} rows", str(len(rows) - 1), "file")
        return None
    times, values = (_numbers(table, rows, head.index(column)) for column in (time, value))
    return None if times is None or values is None else (times, values)


def _inside(table: Table, folder: Path | None, name: str) -> Path | None:
    """Return the file in the scene's own folder, or below it; no link may lead out of it."""
    expected = "a file in the folder of the scene, or below it"
    if folder is None:
        table.fault(expected, "a scene that is in no folder", "file")
        return None
    root = folder.resolve()
    try:
        path = (root / name).resolve()
    except (OSError, ValueError):  # a loop of links, a NUL, or half a character
        table.fault(expected, "a name that no file has", "file")
        return None
    if not path.is_relative_to(root):
        table.fault(expected, name[:60], "file")
        return None
    return path


def _numbers(table: Table, rows: list[list[str]], place: int) -> Vector | None:
    numbers: list[Fraction | None] = []
    for line, row in enumerate(rows[1:], 2):
        try:
            numbers.append(exact_number(row[place].strip()))
        except (ValueError, IndexError) as error:
            reason = str(error) if isinstance(error, ValueError) else "a number"
            table.fault(
                reason, (row[place][:40] if place < len(row) else "nothing"), f"file, line {line}"
            )
            numbers.append(None)
    return complete(numbers)
