"""Columns in a Parquet file, read with pyarrow; those in structs have dotted names.

A list of numbers in each row is as many columns, numbered from 0, if all lists are equally long. What can
hold no numbers is not read: a page of text may be a thousand times its size in the file.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import parquet, types

from taylor_verify.records.faults import cut, refusal
from taylor_verify.solvers.files.formats.column import (
    BYTES,
    CHARACTERS,
    VALUES,
    Column,
    Table,
    check_size,
)
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.memory import bounded_memory
from taylor_verify.solvers.files.formats.missing_library import unbroken

# Sixty characters of a number, and as many bytes more as some remarks have.
_WIDEST: Final = 64
_ROWS_AT_ONCE: Final = 256
_TEXT_BYTES: Final = 2**24
_LISTS: Final = (types.is_list, types.is_large_list, types.is_fixed_size_list)
_NUMBERS: Final = (
    *(types.is_integer, types.is_floating, types.is_decimal, types.is_boolean),
    types.is_timestamp,
)
_BROKEN: Final = (pa.ArrowException, OSError, ValueError)


def read(file: Content, path: Path) -> Table:
    """Return the columns; what the footer says of their size is checked before any is read."""
    with unbroken("a Parquet file", path, _BROKEN), bounded_memory(path):
        footer = parquet.ParquetFile(file.binary)
        names, texts, left = _checked(footer, path)
        long = _long_texts(footer, texts)
        reader = parquet.ParquetFile(file.binary, read_dictionary=texts)
        wanted = [name for name in names if name not in long]
        table = _flat(_in_parts(reader, wanted, path))
        _check_texts(table, texts, path)
        table = _seconds(_without_lists(table, path))
    columns = [Column(name, _values(table.column(i))) for i, name in enumerate(table.column_names)]
    notes = [
        f"not read, because it is longer than numbers are: column {cut(name)}" for name in long
    ]
    notes += [f"not read, because they hold no numbers: {cut(', '.join(left))}"] if left else []
    return Table(columns, tuple(notes))


def _in_parts(reader: Any, names: Sequence[str], path: Path) -> Any:
    """Return the table; one with lists is read in parts, because nothing says how long its lists are."""
    parts, count = [], 0
    has_lists = any(_is_list(field.type) for field in reader.schema_arrow)
    options = {"columns": names, "use_threads": False}
    for part in reader.iter_batches(_ROWS_AT_ONCE, **options) if has_lists else ():
        count += sum(len(c.flatten()) for c in part.columns if _is_list(c.type))
        VALUES.check(count, path)
        parts.append(part)
    return pa.Table.from_batches(parts) if parts else reader.read(**options)


def _checked(footer: Any, path: Path) -> tuple[list[str], list[str], list[str]]:
    """Return the names of the columns of numbers, of those of text among them, and of all others.

    The file is refused if it is too large.
    """
    metadata = footer.metadata
    check_size(metadata.num_columns, metadata.num_rows, path)
    groups = [metadata.row_group(i) for i in range(metadata.num_row_groups)]
    BYTES.check(sum(group.total_byte_size for group in groups), path)
    names, texts, left = list[str](), list[str](), list[str]()
    for field in _flat(footer.schema_arrow.empty_table()).schema:
        has_inner = _is_list(field.type) or types.is_dictionary(field.type)
        kind = field.type.value_type if has_inner else field.type
        if types.is_string(kind) or types.is_large_string(kind):
            texts.append(field.name)
        elif not any(is_such(kind) for is_such in _NUMBERS):
            left.append(field.name)
            continue
        names.append(field.name)
    return names, texts, left


def _is_list(kind: Any) -> bool:
    return any(is_such(kind) for is_such in _LISTS)


def _long_texts(footer: Any, texts: Sequence[str]) -> Sequence[str]:
    """Return the columns of text if they have together more bytes than numbers have.

    The sizes are those of whole groups: pyarrow ends the process where the footer has a fault in what it
    says of a single column.
    """
    metadata = footer.metadata
    groups = (metadata.row_group(i) for i in range(metadata.num_row_groups))
    numbers = _WIDEST * metadata.num_rows * metadata.num_columns
    return texts if sum(g.total_byte_size for g in groups) > _TEXT_BYTES + numbers else ()


def _values(column: Any) -> Any:
    """Return the entries: binary numbers as NumPy has them, and each text of a dictionary once."""
    if types.is_dictionary(column.type):
        return [entry for chunk in column.chunks for entry in _texts(chunk)]
    is_binary = types.is_integer(column.type) or types.is_float64(column.type)
    return column.to_numpy() if is_binary and not column.null_count else column.to_pylist()


def _texts(chunk: Any) -> Iterator[Any]:
    texts = chunk.dictionary.to_pylist()
    return (None if place is None else texts[place] for place in chunk.indices.to_pylist())


def _flat(table: Any) -> Any:
    """Return a table with a column for each field of a struct, named with a dot between."""
    while any(types.is_struct(field.type) for field in table.schema):
        table = table.flatten()
    return table


def _without_lists(table: Any, path: Path) -> Any:
    """Return a table with a column for each place in a list, numbered from 0."""
    columns: dict[str, Any] = {}
    for name, column in zip(table.column_names, table.columns, strict=True):
        if not _is_list(column.type):
            columns[name] = column
            continue
        lengths = pc.min_max(pc.list_value_length(column)).as_py()
        if lengths["min"] != lengths["max"] or column.null_count:
            got = f"lists of {lengths['min']} to {lengths['max']}"
            raise refusal("lists of one length", got, f"{path}, column {name}")
        check_size(len(columns) + (lengths["max"] or 0), len(column), path)
        for k in range(lengths["max"] or 0):
            columns[f"{name}[{k}]"] = pc.list_element(column, k)
    return pa.table(columns)


def _seconds(table: Any) -> Any:
    """Return a table whose times of a calendar are text."""
    for i, field in enumerate(table.schema):
        if types.is_timestamp(field.type):
            texts = pc.strftime(table.column(i), format="%Y-%m-%dT%H:%M:%SZ")
            table = table.set_column(i, field.name, texts)
    return table


def _check_texts(table: Any, names: Collection[str], path: Path) -> None:
    """Look at each text once, where the file holds it once: a row may repeat a long one."""
    for i, name in enumerate(table.column_names):
        for chunk in table.column(i).chunks if name in names else ():
            longest = pc.max(pc.utf8_length(chunk.dictionary)).as_py() or 0
            CHARACTERS.check(longest, f"{path}, column {name}")
