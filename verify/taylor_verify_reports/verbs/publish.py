"""The verb `publish`: the studies that it measures, the pages that it makes of what is stored."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.cli.answer import FAIL, PASS, Answer, WrongCall, graver, lines_of, wrong_calls
from taylor_verify.cli.folders import alone_in, writable
from taylor_verify.cli.progress import advancing, working
from taylor_verify.cli.streams import say
from taylor_verify_reports.studies.registry import STUDIES, UnknownStudy, find, hint
from taylor_verify_reports.verbs.checkout import reports_folder

if TYPE_CHECKING:
    from taylor_verify_reports.studies.bulk import Missing
    from taylor_verify_reports.studies.study import Option, Progress, Study

_TIME: Final = "one to three minutes for all of them on two cores"
_ARCHIVE: Final = "taylor-verify-data"
# The options that do not measure a study.
_OTHERS: Final = ("list", "pages", "paper", "missing", "archive", "site")
# Options whose pages and files cannot say that verdicts were edited.
_UNCAUTIONED: Final = ("paper", "missing", "archive", "site")


help = "write what the project publishes: measure studies, or make pages of what is stored"
example = "publish growth --periods 1e4"


def add(verb: argparse.ArgumentParser) -> None:
    """Add the options of the verb, and those of single studies."""
    # An option that is none is named by the verb, beside what there is: `--growth` was one.
    verb.set_defaults(unknown=[])
    verb.add_argument(
        "studies",
        nargs="*",
        metavar="STUDY",
        help="measure these studies and write what is measured (`publish --list`); default: make all "
        "pages of what is stored",
    )
    verb.add_argument(
        "--from",
        dest="folder",
        metavar="DIR",
        help="the folder of what is published; default: `reports` of the checkout you are in",
    )
    made = verb.add_mutually_exclusive_group()
    verb.add_argument(
        "--edited",
        action="store_true",
        help="make pages of verdicts that were changed since a run wrote them; every page says so",
    )
    made.add_argument("--list", action="store_true", help="list the studies, and do nothing else")
    made.add_argument(
        "--pages", action="store_true", help="make all pages of what is stored (the default)"
    )
    made.add_argument(
        "--paper",
        action="store_true",
        help="make the paper of what is stored, as PDF and LaTeX with its tables and pictures, in "
        "DIR/paper, and draw the pictures of DIR as PDF (needs pypandoc-binary, typst)",
    )
    made.add_argument(
        "--missing",
        action="store_true",
        help="make the files of DIR that a clone of the repository lacks (minutes, all cores)",
    )
    made.add_argument(
        "--archive", metavar="DIST", help="pack DIR into an archive in the folder DIST"
    )
    made.add_argument(
        "--site",
        metavar="SITE",
        help="make one site of the docs and of DIR, in the folder SITE (needs sphinx, myst-nb, furo, "
        "sphinx-copybutton, latex2mathml)",
    )
    for owners, shared in _options_with_owners(STUDIES):
        if shared:
            own = verb.add_argument_group(f"options of {owners}")
            for option in shared:
                given = {"metavar": option.metavar} if option.read else {"action": "store_true"}
                own.add_argument(f"--{option.name}", help=option.help, **given)  # type: ignore[arg-type]


def _options_with_owners(studies: Sequence[Study[Any]]) -> list[tuple[str, tuple[Option, ...]]]:
    """Return the options of the studies, each once, with the names of the studies that have them."""
    owners: dict[tuple[Option, ...], list[str]] = {}
    for study in studies:
        owners.setdefault(study.options, []).append(study.name)
    return [(", ".join(names), shared) for shared, names in owners.items()]


def run(options: argparse.Namespace) -> Answer:
    """Measure the studies that are named; without names, make pages of what is stored."""
    options.studies += options.unknown
    _check_options(options.studies, STUDIES)
    try:
        studies = find(options.studies)
    except UnknownStudy as error:
        raise WrongCall(*lines_of(error)) from error
    other = next((name for name in _OTHERS if getattr(options, name)), "")
    if studies and other:
        raise WrongCall(f"expected studies or --{other}, got both @ publish")
    given = {study.name: _options_of(study, options, studies) for study in STUDIES}
    if other == "list":
        return _listed(STUDIES)
    folder = Path(reports_folder(options.folder, bool(studies)))
    _check_sum(folder, options)
    if other == "site":
        return _site(folder, writable(options.site, "--site"))
    if other == "archive":
        return _packed(folder, writable(options.archive, "--archive"))
    for study in studies:
        _require_heyoka(study)
    if studies or other in {"paper", "missing"}:
        writable(str(folder), "--from")
    makes_a_folder = studies or other in {"paper", "missing"} or folder.is_dir()
    with alone_in(folder if makes_a_folder else None, "--from"):
        if studies:
            return _measured(studies, folder, given)
        if other == "missing":
            return make_missing(folder)
        return _rendered(folder) if other == "paper" else _pages(folder)


def _check_sum(folder: Path, options: argparse.Namespace) -> None:
    """Raise WrongCall for verdicts that were edited, unless they are measured anew or that is said."""
    from taylor_verify.records import store

    if options.edited and any(getattr(options, name) for name in _UNCAUTIONED):
        raise WrongCall("expected --edited for pages alone, got it beside another option @ publish")
    if options.edited or "accuracy" in options.studies:
        return
    with _wrong_calls(folder, ""):
        edited = store.are_edited(folder)
    if edited is not False:
        got = f"others than {store.SUM} is made of" if edited else f"them without {store.SUM}"
        raise WrongCall(
            f"expected the verdicts that a run has written, got {got} "
            f"@ {folder / store.FOLDER / store.VERDICTS} (`publish --edited` makes pages that say so)"
        )


def _check_options(words: Sequence[str], studies: Sequence[Study[Any]]) -> None:
    """Raise WrongCall for words that look like options and are none, with the nearest that is one."""
    own = (option.name for study in studies for option in study.options)
    known = [f"--{name}" for name in (*_OTHERS, "from", "edited", "json", "help", *own)]
    # A study behind two hyphens is left to `find`, which says how it is written.
    named = {f"--{study.name}" for study in studies}
    given = [word.partition("=")[0] for word in words if word.startswith("-")]
    faults = [
        f"expected an option, got {w}; {hint(w, known)} @ publish" for w in given if w not in named
    ]
    if faults:
        raise WrongCall(*faults)


def _options_of(
    study: Study[Any], options: argparse.Namespace, asked: Sequence[Study[Any]]
) -> dict[str, Any]:
    """Return the options of a study that were given. Raises WrongCall for one without its study."""
    given = {}
    for option in study.options:
        value = getattr(options, option.name)
        if value is None or value is False:
            continue
        if not any(option in other.options for other in asked):
            expected = f"expected --{option.name} with `publish {study.name}`"
            named = " ".join(options.studies) or "no study"
            raise WrongCall(f"{expected}, got it with {named} @ publish")
        try:
            given[option.name] = option.read(value) if option.read else value
        except ValueError as error:
            raise WrongCall(f"{error} @ --{option.name}") from error
    return given


def _require_heyoka(study: Study[Any]) -> None:
    """Raise WrongCall without heyoka: published rows must not be replaced by empty ones."""
    from taylor_verify.solvers.taylor.package import lack

    if study.needs_heyoka and (missing := lack()) is not None:
        raise WrongCall(f"{missing} @ publish {study.name}")


def _listed(studies: Sequence[Study[Any]]) -> Answer:
    """Return the studies, what each is, how long it takes and what it asks for."""
    rows = [
        {
            **{name: getattr(study, name) for name in ("name", "title", "duration")},
            "needs_heyoka": study.needs_heyoka,
            "options": {option.name: option.help for option in study.options},
        }
        for study in studies
    ]
    width = max(len(study.name) for study in studies)
    lines = [
        f"{study.name:{width}}  {study.title}\n{'':{width}}  {study.duration}; "
        f"{'needs heyoka' if study.needs_heyoka else 'works without heyoka'}"
        for study in studies
    ]
    return Answer(PASS, {"studies": rows}, lambda: "\n".join(lines))


def _measured(
    studies: Sequence[Study[Any]], folder: Path, given: dict[str, dict[str, Any]]
) -> Answer:
    """Measure each study and make its pages and pictures, then the index if there is one."""
    from taylor_verify.records import store
    from taylor_verify_reports.studies.published_report import publish_index
    from taylor_verify_reports.studies.study import NotMeasured

    answer = _files_written([])
    written: list[Path] = []
    for study in studies:
        if len(studies) > 1:
            say(f"{study.name}: {study.title} ({study.duration})")
        try:
            measured = study.measure(folder, _progress(), **given[study.name])
        except NotMeasured as error:
            raise WrongCall(f"{error} @ publish {study.name}") from error
        made = study.publish(folder)
        written += [*measured.written, *made.written]
        messages = [*answer.messages, *measured.messages, *made.messages]
        answer = answer._replace(status=graver(answer.status, measured.status), messages=messages)
    if (folder / store.FOLDER / store.VERDICTS).exists():
        written += publish_index(folder)
    return _files_written(written)._replace(status=answer.status, messages=answer.messages)


def _progress() -> Progress:
    from taylor_verify_reports.studies.study import Progress

    return Progress(say, advancing, working)


@contextmanager
def _wrong_calls(folder: Path, option: str) -> Iterator[None]:
    """Report faults of a report folder, and a missing package, as wrong calls."""
    from taylor_verify.records import store

    try:
        yield
    except (FileNotFoundError, NotADirectoryError) as error:
        raise WrongCall(
            f"expected what `run --out {folder}` writes ({store.FOLDER}/{store.VERDICTS} first of all), "
            f"got no such file @ {error.filename}"
        ) from error
    except ImportError as error:
        name = error.name or error
        raise WrongCall(f"expected {name} (pip install it), got no such package{option}") from error
    except ValueError as error:
        raise WrongCall(f"{error}{option}") from error


def _pages(folder: Path) -> Answer:
    from taylor_verify_reports.studies import published_report as report

    with _wrong_calls(folder, ""):
        return _files_written(report.publish(folder))


def _rendered(folder: Path) -> Answer:
    with _wrong_calls(folder, " @ --paper"):
        from taylor_verify_reports.studies.paper import pack

        return _files_written(pack.write(folder))


def _site(folder: Path, target: Path) -> Answer:
    from taylor_verify.batch.lock import Occupied

    with wrong_calls(" (--site)", Occupied), _wrong_calls(folder, " @ --site"):
        from taylor_verify_reports.studies.site.builder import build

        made = _files_written(build(folder, target))
    lacking = _missing(folder).data
    message = (
        f"pages of the site are without {lacking}: `taylor-verify publish --missing` makes what "
        f"{folder} lacks ({_TIME})"
    )
    return made._replace(messages=[message] if lacking else [])


def make_missing(folder: Path) -> Answer:
    """Make the files of every study that the repository leaves out.

    The answer fails, and names the rows, if runs made again leave the rounding class of the published ones.
    """
    from taylor_verify_reports.studies.study import Departed

    lacking = _missing(folder)
    if lacking.data:
        say(f"making what is not in {folder}: {lacking.data} ({_TIME})")
    try:
        return _files_written(lacking.make(_progress()))
    except Departed as departed:
        rows = str(departed).splitlines()
        end = f"{len(rows)} departures from their rounding class: no records of these scenes"
        return Answer(FAIL, {"written": [], "departures": rows}, str, [*rows, end])


def _packed(folder: Path, target: Path) -> Answer:
    """Pack everything in ``folder``; refuse a folder that lacks something."""
    from taylor_verify.records.version import __version__
    from taylor_verify_reports.studies.archive import pack

    lacking = _missing(folder)
    renderings = f"{len(lacking.renderings)} files of the paper" if lacking.renderings else ""
    if without := ", ".join(filter(None, (lacking.data, renderings))):
        raise WrongCall(
            "expected a whole report (`publish --missing`, then `publish --paper`), got one without "
            f"{without} @ --archive"
        )
    return _files_written(pack(folder, target, f"{_ARCHIVE}-{__version__}"))


def _missing(folder: Path) -> Missing:
    from taylor_verify_reports.studies import bulk

    with _wrong_calls(folder, ""):
        return bulk.missing(folder)


def _files_written(paths: Iterable[Path]) -> Answer:
    """Return the answer of a verb whose work is files: their names."""
    written = [str(path) for path in paths]
    return Answer(PASS, {"written": written}, lambda: "\n".join(written))
