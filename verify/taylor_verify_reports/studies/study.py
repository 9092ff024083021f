"""A study: a measurement, its document below a report folder, its pages and its pictures.

Each folder of `studies` has one study or more, and `registry` lists all studies. The command
line, the report with its index, the pictures and the missing data are made by loops over that list.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from taylor_verify.plotting.picture import Picture
from taylor_verify.records import store
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.replacement import replace_files
from taylor_verify.records.runs import Run, runs
from taylor_verify.records.verdict import Verdict
from taylor_verify_reports.studies import figures

if TYPE_CHECKING:
    from taylor_verify.batch.judging import Progress as JobProgress

Document = TypeVar("Document")


def whole_number(text: str, least: int | None = None) -> int:
    """Return the whole number of an option. Raises ValueError for other text, and for a smaller number."""
    with suppress(ValueError):
        if least is None or int(text) >= least:
            return int(text)
    limit = "" if least is None else f" of at least {least}"
    raise ValueError(f"expected a whole number{limit}, got {text!r:.60}")


class NotMeasured(ValueError):  # noqa: N818 (it names what did not happen)
    """A study cannot be measured with the given options; the text is the message to the user."""


class Departed(ValueError):  # noqa: N818 (it names what happened)
    """Runs made again have numbers outside the rounding class of the published ones; a line for each."""


@dataclass(frozen=True)
class Progress:
    """Reports on the progress of a measurement; silent by default.

    ``say`` shows a line of text, ``jobs`` opens a progress bar for many runs, and ``working`` shows that
    one long task is running.
    """

    say: Callable[[str], None] = lambda words: None
    jobs: Callable[[], AbstractContextManager[JobProgress | None]] = nullcontext
    working: Callable[[str], AbstractContextManager[None]] = lambda what: nullcontext()

    def counting(self, total: int) -> Callable[[str], None]:
        """Return a function that reports each finished item with its number and the total."""
        done = 0

        def finished(name: str) -> None:
            nonlocal done
            done += 1
            self.say(f"{done}/{total} {name}")

        return finished


class Measured(NamedTuple):
    """Files that a study has written, messages to the user, and the exit status."""

    written: Sequence[Path] = ()
    messages: Sequence[str] = ()
    status: int = 0


@dataclass(frozen=True)
class Option:
    """An option of one study; ``name`` is its name without hyphens.

    ``read`` makes the value from a text, and raises a ValueError that says what was expected and what it
    got. An option without ``read`` is a switch. ``metavar`` stands for the value in the help text.
    """

    name: str
    help: str
    read: Callable[[str], Any] | None = None
    metavar: str = "N"


@dataclass(frozen=True)
class Published:
    """The verdicts of a report folder, and the SHA-256 of every scene that can be run."""

    folder: Path
    verdicts: tuple[Verdict, ...]
    digests: Mapping[str, str]

    @cached_property
    def runs(self) -> tuple[Run, ...]:
        """The runs of scenes that can be run."""
        return tuple(run for run in runs(self.verdicts) if run.scene in self.digests)

    def outdated_scenes(self, place: str) -> tuple[str, ...]:
        """Return the scenes whose document in the folder ``place`` is missing or of an older text."""
        scenes = dict.fromkeys(run.scene for run in self.runs)
        return tuple(s for s in scenes if self._digest(place, s) != self.digests[s])

    def _digest(self, place: str, scene: str) -> Any:
        """Return the SHA-256 of the scene that a document was made from; None without a document."""
        file = self.folder / place / f"{of_scene(scene)}.json"
        return store.read_document(file).get("sha256") if file.exists() else None


@dataclass(frozen=True)
class Bulk:
    """Files of a study that are made from stored data, and that the repository leaves out.

    ``what`` names the files after their number: "3 records of runs". ``patterns`` are their lines of
    .gitignore, relative to the report folder. ``lacking`` returns what is missing in a report or made from
    older verdicts or scenes; ``make`` makes these files and returns them.
    """

    what: str
    patterns: tuple[str, ...]
    lacking: Callable[[Published], Sequence[Any]]
    make: Callable[[Path, Sequence[Any], Progress], Iterable[Path]]


@dataclass(frozen=True)
class Study(Generic[Document]):
    """A measurement with everything that is published of it.

    Attributes
    ----------
    name, title
        Its name on the command line, and the contents of its page in a few words.
    duration
        The time that the measurement takes, in words.
    measure
        ``measure(folder, progress, **options)`` measures and writes below the folder. It imports its
        modules when it is called, so that the list of all studies loads fast. Raises NotMeasured.
    find
        Returns the document stored below a folder; None if there is none.
    page
        Makes the page of a document. Its second argument is the folder, whose pictures it shows.
    sheet
        Makes the CSV sheet of a document, with every digit.
    beside
        Makers of further pages and sheets, by their paths below the folder.
    parts
        Makes further pages, by their paths; which ones depends on the document.
    draw
        Returns the pictures of a document.
    place
        The path of the page, if it is not tables/NAME.md.
    needs_heyoka
        True if the measurement runs heyoka.
    options
        The options of this study alone.
    bulk
        Files that the repository leaves out.
    """

    name: str
    title: str
    duration: str
    measure: Callable[..., Measured]
    find: Callable[[Path], Document | None] = lambda folder: None
    page: Callable[[Document, Path], str] | None = None
    sheet: Callable[[Document], str] | None = None
    beside: Mapping[str, Callable[[Document], str]] = field(default_factory=dict)
    parts: Callable[[Document], Mapping[str, str]] = lambda document: {}
    draw: Callable[[Document], Iterable[Picture]] = lambda document: ()
    place: str = ""
    needs_heyoka: bool = True
    options: tuple[Option, ...] = ()
    bulk: tuple[Bulk, ...] = ()

    @property
    def path(self) -> str:
        """The path of the page below the folder, for indexes; empty for a study without a page."""
        return self.place or (f"tables/{self.name}.md" if self.page else "")

    def pages(self, folder: Path) -> dict[str, str]:
        """Return the pages and sheets of the document stored below ``folder``; empty without one.

        Raises OSError for files that cannot be read and ValueError for files that hold something else.
        """
        document = self.find(folder)
        return {} if document is None else self._pages(document, folder)

    def pictures(self, folder: Path) -> list[Picture]:
        """Return the pictures of the document stored below ``folder``. Raises the errors of `pages`."""
        document = self.find(folder)
        return [] if document is None else [*self.draw(document)]

    def publish(self, folder: Path) -> Measured:
        """Draw the pictures of the document stored below ``folder``, then make its pages.

        Without matplotlib only the pages are made, and a message says so. Raises the errors of `pages`, and
        OSError for files that cannot be written.
        """
        document = self.find(folder)
        if document is None:
            return Measured()
        drawn: list[Path] = []
        messages: list[str] = []
        try:
            drawn = figures.draw(folder, self.draw(document))
        except ImportError as error:
            messages = [f"pictures of {self.name} are not drawn: {error}"]
        return Measured([*drawn, *replace_files(folder, self._pages(document, folder))], messages)

    def _pages(self, document: Document, folder: Path) -> dict[str, str]:
        data = folder / store.FOLDER
        file = data / f"{self.name}.json"
        place = file if file.exists() else data
        with store.expecting(f"what `publish {self.name}` writes", place):
            texts = {path: make(document) for path, make in self.beside.items()}
            texts |= self.parts(document)
            if self.sheet:
                texts = {f"tables/{self.name}.csv": self.sheet(document), **texts}
            page = self.page(document, folder) if self.page else ""
            return {self.path: page, **texts} if page else texts
