"""Columns in a Parquet file, read with pyarrow; those in structs have dotted names.

What can hold no numbers is not read: a page of text may be a thousand times its size in the file.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.faults import Faults, Refused, cut, refusal
from taylor_verify.solvers.files.formats.column import (
    BYTES,
    CHARACTERS,
    Column,
    Table,
    check_size,
    refuse_part,
)
from taylor_verify.solvers.files.formats.content import Content

# Sixty characters of a number, and as many bytes more as some remarks have.
_WIDEST: Final = 64
_TEXT_BYTES: Final = 2**24


def read(file: Content, path: Path, part: str) -> Table:
    """Return the columns; what the footer says of their size is checked before any is read."""
    refuse_part(part, path)
    from pyarrow import ArrowException, parquet

    try:
        footer = parquet.ParquetFile(file.binary)
        texts = _checked(footer, path)
        long = _long_texts(footer, texts)
        wanted = [name for name in footer.schema_arrow.names if name not in long]
        table = parquet.ParquetFile(file.binary, read_dictionary=texts).read(
            wanted, use_threads=False
        )
    except MemoryError:
        raise
    except (ArrowException, OSError, ValueError) as error:
        reason = str(error).splitlines()[0]
        raise refusal("a Parquet file", f"a fault in it: {reason}", path) from None
    table = _flat(table)
    _check_texts(table, texts, path)
    columns = [Column(name, _values(table.column(i))) for i, name in enumerate(table.column_names)]
    notes = [
        f"not read, because it is longer than numbers are: column {cut(name)}" for name in long
    ]
    return Table(columns, tuple(notes))


def _checked(footer: Any, path: Path) -> list[str]:
    """Return the names of the columns of text, if the file is not too large and holds numbers."""
    import pyarrow as pa

    metadata = footer.metadata
    check_size(metadata.num_columns, metadata.num_rows, path)
    groups = [metadata.row_group(i) for i in range(metadata.num_row_groups)]
    BYTES.check(sum(group.total_byte_size for group in groups), path)
    is_a, faults, texts = pa.types, Faults(), []
    numbers = (is_a.is_integer, is_a.is_floating, is_a.is_decimal, is_a.is_boolean)
    for field in _flat(footer.schema_arrow.empty_table()).schema:
        if is_a.is_string(field.type) or is_a.is_large_string(field.type):
            texts.append(field.name)
        elif not any(is_such(field.type) for is_such in numbers):
            place = f"{path}, column {field.name}"
            faults.add("a column of numbers", f"the type {field.type}", place)
    if faults.lines:
        raise Refused(faults.lines)
    return texts


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
    import pyarrow as pa

    if pa.types.is_dictionary(column.type):
        return [entry for chunk in column.chunks for entry in _texts(chunk)]
    is_binary = pa.types.is_integer(column.type) or pa.types.is_float64(column.type)
    return column.to_numpy() if is_binary and not column.null_count else column.to_pylist()


def _texts(chunk: Any) -> Iterator[Any]:
    texts = chunk.dictionary.to_pylist()
    return (None if place is None else texts[place] for place in chunk.indices.to_pylist())


def _flat(table: Any) -> Any:
    """Return a table with a column for each field of a struct, named with a dot between."""
    import pyarrow as pa

    while any(pa.types.is_struct(field.type) for field in table.schema):
        table = table.flatten()
    return table


def _check_texts(table: Any, names: Collection[str], path: Path) -> None:
    """Look at each text once, where the file holds it once: a row may repeat a long one."""
    import pyarrow.compute as pc

    for i, name in enumerate(table.column_names):
        for chunk in table.column(i).chunks if name in names else ():
            longest = pc.max(pc.utf8_length(chunk.dictionary)).as_py() or 0
            CHARACTERS.check(longest, f"{path}, column {name}")
