"""The content of a trajectory file: every way to read it has a limit, and there is no other."""

from __future__ import annotations

import codecs
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Iterator
from functools import cached_property, partial
from io import TextIOWrapper
from pathlib import Path
from typing import BinaryIO, Final, final

from taylor_verify.records.faults import Refused, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.solvers.files.formats.column import LINE, LINES

_BEGINNING: Final = 4096
_CONTROL: Final = frozenset({*range(32), 127}) - frozenset(b"\t\n\r\f")


# Bytes that are no UTF-8 are letters of Latin-1, such as the sign of degrees in a header.
_LATIN_1: Final = "latin-1 in its place"


def _as_latin_1(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeDecodeError):
        raise error
    return error.object[error.start : error.end].decode("latin-1"), error.end


codecs.register_error(_LATIN_1, _as_latin_1)


@final
class Content:
    """An open regular file of bounded size.

    A library that opens the file by itself gets ``binary``; its reader checks what the file declares of
    rows, columns and bytes before it lets the library make anything of them.
    """

    def __init__(self, file: BinaryIO, path: Path) -> None:
        self._file, self.path = file, path

    @property
    def binary(self) -> BinaryIO:
        """The bytes from the beginning, for a library."""
        self._file.seek(0)
        return self._file

    def beginning(self, count: int) -> bytes:
        """Return the first bytes."""
        return self.binary.read(count)

    @property
    def looks_like_text(self) -> bool:
        """True if the beginning is not empty and has no control characters but those of lines."""
        start = self.beginning(_BEGINNING)
        return bool(start.strip()) and not _CONTROL.intersection(start)

    def whole(self, most: Limit) -> bytes:
        """Return all bytes. Raises Refused if there are more than the limit."""
        content = self.binary.read(most.most + 1)
        if len(content) > most.most:
            raise most.refusal("more", self.path)
        return content

    def text(self, most: Limit) -> str:
        """Return all of a text in UTF-8 or 16. Raises Refused for other bytes, and at the limit."""
        try:
            return self.whole(most).decode(self._encoding)
        except UnicodeDecodeError:
            raise self._other_bytes from None

    def lines(self, longest: Limit = LINE) -> Iterator[str]:
        """Yield the lines of a text in UTF-8, Latin-1 or UTF-16, blank ones too, each with its end.

        Raises Refused for other bytes, and at the limits of a line and of their number.
        """
        self._text.seek(0)
        try:
            limited = iter(partial(self._text.readline, longest.most + 1), "")
            for number, line in enumerate(limited, start=1):
                if len(line) > longest.most:
                    raise longest.refusal("more", f"{self.path}, line {number}")
                if "\0" in line:
                    raise self._other_bytes
                if number > LINES.most:
                    raise LINES.refusal("more", self.path)
                yield line
        except UnicodeDecodeError:
            raise self._other_bytes from None

    @property
    def _other_bytes(self) -> Refused:
        got = "UTF-16 (save it as UTF-8)" if self._encoding == "utf-16" else "other bytes"
        return refusal("text in UTF-8", got, self.path)

    @cached_property
    def _text(self) -> TextIOWrapper:
        errors = "strict" if self._encoding == "utf-16" else _LATIN_1
        return TextIOWrapper(self.binary, self._encoding, errors)

    @cached_property
    def _encoding(self) -> str:
        """UTF-16, which PowerShell writes, has a byte order mark."""
        has_mark = self.beginning(2) in (BOM_UTF16_BE, BOM_UTF16_LE)
        return "utf-16" if has_mark else "utf-8-sig"
