"""The verb `publish`: the studies that it measures, the pages that it makes of what is stored."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.cli.answer import PASS, Answer, WrongCall, files_written, graver
from taylor_verify.cli.folders import alone_in, reports_folder, writable
from taylor_verify.cli.progress import advancing, working
from taylor_verify.cli.streams import say

if TYPE_CHECKING:
    from taylor_verify.studies.bulk import Missing
    from taylor_verify.studies.study import Progress, Study

_TIME: Final = "one to three minutes for all of them on two cores"
_ARCHIVE: Final = "taylor-verify-data"


def add_options(verb: argparse.ArgumentParser, in_full: bool) -> None:
    """Add the options of the verb; those of single studies only ``in_full``, for they are imported."""
    verb.add_argument(
        "studies",
        nargs="*",
        metavar="STUDY",
        help="measure and write these; `publish --list` names them; default: make all pages of what is "
        "stored",
    )
    verb.add_argument(
        "--from", dest="folder", metavar="DIR", help="default: reports of the checkout around"
    )
    made = verb.add_mutually_exclusive_group()
    made.add_argument("--list", action="store_true", help="instead list the studies")
    made.add_argument(
        "--pages", action="store_true", help="make all pages of what is stored, the default"
    )
    made.add_argument(
        "--paper",
        action="store_true",
        help="instead render the pages of DIR as LaTeX and HTML, into DIR/tables, and draw their "
        "pictures as PDF",
    )
    made.add_argument(
        "--missing",
        action="store_true",
        help="instead make what a clone of the repository lacks in DIR (minutes, all cores)",
    )
    made.add_argument("--archive", metavar="DIST", help="instead pack DIR into the folder DIST")
    made.add_argument(
        "--site",
        metavar="SITE",
        help="instead make static pages of what DIR holds, into the folder SITE (jinja2, "
        "markdown-it-py, latex2mathml, plotly)",
    )
    if in_full:
        _add_options_of_studies(verb)


def _add_options_of_studies(verb: argparse.ArgumentParser) -> None:
    from taylor_verify.studies.registry import STUDIES

    for study in STUDIES:
        own = verb.add_argument_group(f"options of {study.name}") if study.options else None
        for option in study.options if own else ():
            given: dict[str, Any] = (
                {"metavar": option.metavar} if option.read else {"action": "store_true"}
            )
            assert own is not None
            own.add_argument(f"--{option.name}", help=option.help, **given)


def publish(options: argparse.Namespace) -> Answer:
    """Measure the studies that are named; without names, make pages of what is stored."""
    from taylor_verify.studies.registry import STUDIES, UnknownStudy, find

    try:
        studies = find(options.studies)
    except UnknownStudy as error:
        raise WrongCall(str(error)) from error
    others = {"list", "pages", "paper", "missing", "archive", "site"}
    if studies and (other := next(filter(partial(getattr, options), sorted(others)), None)):
        raise WrongCall(f"expected studies or --{other}, got both @ publish")
    given = {study.name: _options_of(study, options, study in studies) for study in STUDIES}
    if options.list:
        return _listed(STUDIES)
    folder = reports_folder(options.folder, measures=any(s.name != "gallery" for s in studies))
    if options.site is not None:
        return _site(folder, str(writable(options.site, "--site")))
    if options.archive is not None:
        return _packed(Path(folder), writable(options.archive, "--archive"))
    for study in studies:
        _require_heyoka(study)
    if studies or options.paper or options.missing:
        place = writable(folder, "--from")
        with alone_in(place, "--from"):
            if studies:
                return _measured(studies, place, given)
            return _rendered(place) if options.paper else make_missing(place)
    with _stored(folder), alone_in(Path(folder) if Path(folder).is_dir() else None, "--from"):
        from taylor_verify.studies.report import publish as made

        return files_written(made(folder))


def _options_of(study: Study[Any], options: argparse.Namespace, is_asked: bool) -> dict[str, Any]:
    """Return the options of a study that were given. Raises WrongCall for one without its study."""
    given = {}
    for option in study.options:
        value = getattr(options, option.name)
        if value is None or value is False:
            continue
        if not is_asked:
            raise WrongCall(
                f"expected --{option.name} with `publish {study.name}`, got it without @ publish"
            )
        try:
            given[option.name] = option.read(value) if option.read else value
        except ValueError as error:
            raise WrongCall(f"{error} @ --{option.name}") from error
    return given


def _require_heyoka(study: Study[Any]) -> None:
    """Raise WrongCall without heyoka: what is published must not be replaced by rows of nothing."""
    from taylor_verify.solvers.taylor.package import lack

    if study.needs_heyoka and (missing := lack()) is not None:
        raise WrongCall(f"{missing} @ publish {study.name}")


def _listed(studies: Sequence[Study[Any]]) -> Answer:
    """Return the studies, what each is, how long it takes and what it asks for."""
    rows = [
        {
            "name": study.name,
            "title": study.title,
            "duration": study.duration,
            "needs_heyoka": study.needs_heyoka,
            "options": {option.name: option.help for option in study.options},
        }
        for study in studies
    ]
    width = max(len(study.name) for study in studies)
    lines = [
        f"{study.name:{width}}  {study.title}\n{'':{width}}  {study.duration}; "
        f"{'needs heyoka' if study.needs_heyoka else 'exact, without heyoka'}"
        for study in studies
    ]
    return Answer(PASS, {"studies": rows}, lambda: "\n".join(lines))


def _measured(
    studies: Sequence[Study[Any]], folder: Path, given: dict[str, dict[str, Any]]
) -> Answer:
    """Measure, draw and tell each study, then make the index anew where there is one."""
    from taylor_verify.records import store
    from taylor_verify.studies.report import publish_index
    from taylor_verify.studies.study import NotMeasured

    written: list[Path] = []
    messages: list[str] = []
    status = PASS
    for study in studies:
        if len(studies) > 1:
            say(f"{study.name}: {study.title} ({study.duration})")
        try:
            found = study.measure(folder, _progress(), **given[study.name])
        except NotMeasured as error:
            raise WrongCall(f"{error} @ publish {study.name}") from error
        made = study.publish(folder)
        written += [*found.written, *made.written]
        messages += [*found.messages, *made.messages]
        status = graver(status, found.status)
    if (folder / store.FOLDER / store.VERDICTS).exists():
        written += publish_index(folder)
    return files_written(written)._replace(status=status, messages=messages)


def _progress() -> Progress:
    from taylor_verify.studies.study import Progress

    return Progress(say, advancing, working)


@contextmanager
def _stored(folder: Path | str) -> Iterator[None]:
    """Tell what a report folder lacks or has wrong as a wrong call."""
    from taylor_verify.records import store

    try:
        yield
    except FileNotFoundError as error:
        raise WrongCall(
            f"expected what `run --out {folder}` writes ({store.FOLDER}/{store.VERDICTS} first of all), "
            f"got no such file @ {error.filename}"
        ) from error
    except ValueError as error:
        raise WrongCall(str(error)) from error


def _made_with(option: str, what: Callable[[], list[Path]]) -> Answer:
    """Return the answer of a rendering, whose packages may be missing."""
    try:
        return files_written(what())
    except ImportError as error:
        name = error.name or error
        raise WrongCall(
            f"expected {name} (pip install it), got no such package @ {option}"
        ) from error
    except ValueError as error:
        raise WrongCall(f"{error} @ {option}") from error


def _rendered(folder: Path) -> Answer:
    """The pages that are there, as LaTeX and HTML."""
    from taylor_verify.studies import paper

    return _made_with("--paper", partial(paper.write, folder))


def _site(folder: str, target: str) -> Answer:
    """The pages that a browser shows, from what the folder holds already."""

    def build() -> list[Path]:
        from taylor_verify.studies.site.builder import build

        return build(folder, target)

    with _stored(folder):
        answer = _made_with("--site", build)
        return answer._replace(messages=_missing_from_pages(Path(folder)))


def make_missing(folder: Path) -> Answer:
    """Make what no clone has: of every study the files that the repository leaves out."""
    lacking = _missing(folder)
    if lacking.data:
        say(f"making what is not in {folder}: {lacking.data} ({_TIME})")
    return files_written(lacking.make(_progress()))


def _packed(folder: Path, target: Path) -> Answer:
    """Pack everything in ``folder``; refuse a folder that lacks something."""
    from taylor_verify.records.version import __version__
    from taylor_verify.studies.archive import pack

    lacking = _missing(folder)
    if lacking.data or lacking.renderings:
        renderings = f"{len(lacking.renderings)} renderings" if lacking.renderings else ""
        raise WrongCall(
            "expected a whole report (`publish --missing`, then `publish --paper`), got one without "
            f"{', '.join(filter(None, (lacking.data, renderings)))} @ --archive"
        )
    return files_written(pack(folder, target, f"{_ARCHIVE}-{__version__}"))


def _missing_from_pages(folder: Path) -> list[str]:
    """A message about the data that the pages of the site are without; none for a whole folder."""
    lacking = _missing(folder)
    if not lacking.data:
        return []
    return [
        f"pages of the site are without {lacking.data}: `taylor-verify publish --missing` makes "
        f"what {folder} lacks ({_TIME})"
    ]


def _missing(folder: Path) -> Missing:
    from taylor_verify.scenes.library import names
    from taylor_verify.scenes.reading.reader import load
    from taylor_verify.studies import bulk

    with _stored(folder):
        return bulk.missing(folder, {name: load(name).digest for name in names()})
