"""Documents of a report folder: written by measurements, read by pages and pictures."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from taylor_verify.records import store
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.json_text import complete, read
from taylor_verify.records.replacement import first_line, replace_files

if TYPE_CHECKING:
    from taylor_verify.scenes.scene import Scene
    from taylor_verify_reports.studies.study import Progress

Document = TypeVar("Document")
# The maker of a scene's document, a function of a module.
Make = Callable[["Scene"], dict[str, Any]]


def made_by(study: str) -> dict[str, str]:
    """Return the key ``made_by``, with which a document of ``study`` names its maker."""
    return {"made_by": f"taylor-verify publish {study}; do not edit"}


@dataclass(frozen=True)
class Stored(Generic[Document]):
    """A type of document and its place, data/STEM.json below the report folder.

    ``stem`` is by default the name of the study. ``fields`` returns the keys and values of a document that
    are stored; ``reader`` reads a document from a file.
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
        """Return the document stored below ``folder``; None if there is none."""
        return self.load(folder) if (folder / self.name).exists() else None


@dataclass(frozen=True)
class SceneDocuments:
    """JSON files below ``folder``, one for each scene; their first line names their ``maker``.

    ``separators`` are those of json.dumps. ``form`` returns the keys and values of a document in its file.
    """

    folder: str
    maker: str
    separators: tuple[str, str] = (", ", ": ")
    form: Callable[[Mapping[str, Any]], Mapping[str, Any]] = lambda document: document

    def name(self, scene: str) -> str:
        """Return the path of a scene's document below the report."""
        return f"{self.folder}/{of_scene(scene)}.json"

    def texts(self, documents: Iterable[Mapping[str, Any]]) -> dict[str, str]:
        """Return the text of each document by its path below the report; every key has its own line."""
        return {self.name(str(document["scene"])): self._text(document) for document in documents}

    def _text(self, document: Mapping[str, Any]) -> str:
        encoder = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=self.separators)
        keys = {"made_by": self.maker, **self.form(document)}
        return (
            "{"
            + ",\n ".join(f"{json.dumps(k)}: {encoder.encode(v)}" for k, v in keys.items())
            + "}\n"
        )

    def write(self, report: Path, documents: Iterable[Mapping[str, Any]]) -> list[Path]:
        """Write documents in place of earlier ones, and return the files written.

        Documents of scenes that no longer exist are removed; files of another maker stay. Raises OSError;
        the folder then stays as it was.
        """
        return list(replace_files(report, self.texts(documents), stale=self.own(report)))

    def add(self, report: Path, documents: Iterable[Mapping[str, Any]]) -> list[Path]:
        """Write documents beside the stored ones, and return the files written. Raises OSError."""
        return list(replace_files(report, self.texts(documents)))

    def add_made(
        self, report: Path, make: Make, scenes: Sequence[str], progress: Progress
    ) -> list[Path]:
        """Make documents of scenes, and write each as it ends; return the files. Raises Failed, OSError."""
        written: list[Path] = []
        documents(make, scenes, progress, lambda one: written.extend(self.add(report, [one])))
        return written

    def find(self, report: Path, scene: str) -> dict[str, Any] | None:
        """Return the document of a scene; None if there is none.

        Raises OSError for a file that cannot be read and ValueError for one that holds something else.
        """
        file = report / self.name(scene)
        return store.read_document(file) if file.exists() else None

    def own(self, report: Path) -> list[Path]:
        """Return the files of the folder that have this maker in their first line."""
        first = f'{{"made_by": {json.dumps(self.maker)},'
        return [file for file in (report / self.folder).glob("*.json") if first_line(file) == first]


# Documents of many shipped scenes, made on all cores.


def documents(
    make: Make,
    names: Sequence[str],
    progress: Progress,
    keep: Callable[[dict[str, Any]], object] = lambda document: None,
) -> list[dict[str, Any]]:
    """Return ``make(scene)`` for many scenes, in the order given.

    As each scene ends, ``keep`` is called with its document. Raises Failed for one that came to nothing.
    """

    from taylor_verify.batch.failure import Failed
    from taylor_verify.batch.work import run_all

    finished = progress.counting(len(names))

    def ended(name: str, document: dict[str, Any]) -> None:
        keep(document)
        finished(name)

    return run_all(partial(document, make), names, ended=ended, raises=Failed)


def document(make: Make, name: str) -> dict[str, Any]:
    """Return ``make(scene)`` for one scene. Raises Failed with its name."""
    from taylor_verify.batch.failure import failing
    from taylor_verify.exact.solution import Unsettled
    from taylor_verify.scenes.reading.reader import load

    with failing(name, Unsettled):
        return make(load(name))
