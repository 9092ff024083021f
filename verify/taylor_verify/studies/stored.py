"""A document of a report folder: written by the one who measured it, read by whoever tells of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

from taylor_verify.records import store
from taylor_verify.records.json_text import complete, read
from taylor_verify.records.replacement import replace_files

Document = TypeVar("Document")


def made_by(study: str) -> dict[str, str]:
    """Return the key with which a document names its maker."""
    return {"made_by": f"taylor-verify publish {study}; do not edit"}


@dataclass(frozen=True)
class Stored(Generic[Document]):
    """A type of documents, and the study that writes one: to data/NAME.json, after the study unless given.

    ``fields`` makes keys and values of a document, ``reader`` a document of a file.
    """

    kind: type[Document]
    study: str
    fields: Callable[[Document], Mapping[str, Any]] = complete
    reader: Callable[[Path, type[Document]], Document] = read
    stem: str = ""

    @property
    def name(self) -> str:
        """The path of the document below the folder."""
        return f"{store.FOLDER}/{self.stem or self.study}.json"

    def write(self, folder: Path, document: Document) -> list[Path]:
        """Store a document below ``folder``. Raises OSError."""
        text = store.laid_out({**made_by(self.study), **self.fields(document)})
        return list(replace_files(folder, {self.name: text}))

    def load(self, folder: Path) -> Document:
        """Return the document that is stored below ``folder``.

        Raises OSError for a file that cannot be read and ValueError for one that holds something else.
        """
        return self.reader(folder / self.name, self.kind)

    def find(self, folder: Path) -> Document | None:
        """Return the document that is stored below ``folder``; None where there is none."""
        return self.load(folder) if (folder / self.name).exists() else None
