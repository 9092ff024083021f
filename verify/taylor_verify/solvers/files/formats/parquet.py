"""Columns in a Parquet file, read with pyarrow; those in structs have dotted names."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any, BinaryIO

from taylor_verify.scenes.reading.faults import Faults, Refused
from taylor_verify.solvers.files.formats.column import BYTES, CHARACTERS, Column, check_size
from taylor_verify.solvers.files.formats.package import needed


def read(file: BinaryIO, path: Path) -> list[Column]:
    """Return the columns; what the footer says of their size is checked before any is read."""
    with needed("pyarrow", "Parquet", "parquet", path):
        from pyarrow import ArrowException, parquet
    try:
        footer = parquet.ParquetFile(file)
        texts = _checked(footer, path)
        table = parquet.ParquetFile(file, read_dictionary=texts).read(use_threads=False)
    except MemoryError:
        raise
    except (ArrowException, OSError, ValueError) as error:
        reason = str(error).splitlines()[0]
        raise Refused([f"expected a Parquet file, got a fault in it: {reason} @ {path}"]) from None
    for _ in range(_depth(footer.schema_arrow)):
        table = table.flatten()
    _check_texts(table, texts, path)
    return [Column(name, table.column(i).to_pylist()) for i, name in enumerate(table.column_names)]


def _checked(footer: Any, path: Path) -> list[str]:
    """The names of the columns of text, if the file is not too large and holds numbers."""
    import pyarrow as pa

    metadata, schema = footer.metadata, footer.schema_arrow
    check_size(metadata.num_columns, metadata.num_rows, path)
    groups = [metadata.row_group(i) for i in range(metadata.num_row_groups)]
    BYTES.check(sum(group.total_byte_size for group in groups), path)
    faults, texts = Faults(), []
    for field in _fields(schema):
        if pa.types.is_string(field.type) or pa.types.is_large_string(field.type):
            texts.append(field.name)
        elif not _is_number(field.type):
            place = f"{path}, column {field.name}"
            faults.add("a column of numbers", f"the type {field.type}", place)
    if faults.lines:
        raise Refused(faults.lines)
    return texts


def _fields(schema: Any) -> Iterator[Any]:
    """The columns, those in a column of structs by their dotted names."""
    import pyarrow as pa

    for field in schema:
        if pa.types.is_struct(field.type):
            yield from _fields(
                [inner.with_name(f"{field.name}.{inner.name}") for inner in field.type]
            )
        else:
            yield field


def _depth(fields: Any) -> int:
    """How deep structs are nested."""
    import pyarrow as pa

    return max((1 + _depth(f.type) for f in fields if pa.types.is_struct(f.type)), default=0)


def _is_number(kind: Any) -> bool:
    import pyarrow as pa

    kinds = (pa.types.is_integer, pa.types.is_floating, pa.types.is_decimal, pa.types.is_boolean)
    return any(is_such(kind) for is_such in kinds)


def _check_texts(table: Any, names: Collection[str], path: Path) -> None:
    """Look at each text once, where the file holds it once: a row may repeat a long one."""
    import pyarrow.compute as pc

    for i, name in enumerate(table.column_names):
        for chunk in table.column(i).chunks if name in names else ():
            longest = pc.max(pc.utf8_length(chunk.dictionary)).as_py() or 0
            CHARACTERS.check(longest, f"{path}, column {name}")
