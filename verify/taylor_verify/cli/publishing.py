"""The verb `publish`: what it computes or measures anew, and the pages it makes."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from math import inf
from pathlib import Path

from taylor_verify.cli.answer import Answer, WrongCall, files_written
from taylor_verify.cli.folders import alone_in, reports_folder, writable
from taylor_verify.cli.missing import make_missing, missing_from_pages, pack
from taylor_verify.cli.progress import counting
from taylor_verify.cli.streams import say

# The rung on which the extremes are published, as `make verify` runs them.
_ON = "f64"


def add_options(verb: argparse.ArgumentParser) -> None:
    """Add the options of the verb: what is made, and from which folder."""
    verb.add_argument(
        "--from", dest="folder", metavar="DIR", help="default: reports of the checkout around"
    )
    made = verb.add_mutually_exclusive_group()
    made.add_argument(
        "--reference",
        action="store_true",
        help="instead compute the exact trajectory of every shipped scene, as CSV and JSON with "
        "32 digits, into DIR/reference",
    )
    made.add_argument(
        "--portraits",
        action="store_true",
        help="instead gather all that a page shows of each shipped scene (equations, exact motion, "
        "numbers of the orbit) into DIR/data/portraits (a minute, all cores)",
    )
    made.add_argument(
        "--gallery",
        action="store_true",
        help="instead draw some motions and their errors from what DIR holds (matplotlib), into "
        "DIR/figures",
    )
    made.add_argument(
        "--controls",
        action="store_true",
        help="instead run the solvers that are broken on purpose and the calls of heyoka that go "
        "wrong, and write what each gate sees of them into DIR/data and DIR/tables",
    )
    made.add_argument(
        "--enclosure",
        action="store_true",
        help="instead enclose two motions without a closed form, and draw the proven width beside the true "
        "error (matplotlib), into DIR/data and DIR/figures (a minute)",
    )
    made.add_argument(
        "--claims",
        action="store_true",
        help="instead run the ledger of both source texts, and write DIR/claims.md, the errata in front",
    )
    made.add_argument(
        "--prices",
        action="store_true",
        help="instead measure what each thing that a scene may ask for costs (minutes; a quiet "
        "machine), and write DIR/data/prices.json and DIR/tables/prices.md",
    )
    made.add_argument(
        "--tradeoff",
        action="store_true",
        help="instead measure speed against accuracy on four scenes, in fresh processes (minutes; a "
        "quiet machine), and write errors and times into DIR/data and a page into DIR/tables",
    )
    made.add_argument(
        "--extremes",
        action="store_true",
        help="instead run the extremes on f64 and write what becomes of each, beside what was expected, "
        "into DIR/data/extremes.json and DIR/tables/extremes.md (minutes, all cores)",
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
        help="instead make static pages of docs and of what DIR holds, into the folder SITE (sphinx, "
        "myst-parser, furo, sphinx-copybutton, latex2mathml, plotly)",
    )
    made.add_argument(
        "--worst",
        action="store_true",
        help="instead hunt for the largest error over attainable in families of extremes, and write "
        "DIR/data/worst.json, DIR/tables/worst.md and the scenes of cases/extremes/worst",
    )
    made.add_argument(
        "--reach",
        action="store_true",
        help="instead measure how many digits each precision leaves of families of extremes, over "
        "their number and periods (minutes, all cores), and write DIR/data/reach.json, "
        "DIR/tables/reach.md and its pictures",
    )
    made.add_argument(
        "--growth",
        action="store_true",
        help="instead follow ensembles of starts over decades of time (ten minutes, all cores), and "
        "write how each error grows into DIR/data/growth.json and DIR/tables/growth.md; stopped, it "
        "goes on from DIR/local/growth",
    )
    verb.add_argument(
        "--seconds", type=float, default=600.0, metavar="S", help="of --worst; default: 600"
    )
    verb.add_argument("--seed", type=int, default=1, metavar="N", help="of --worst; default: 1")
    verb.add_argument(
        "--periods", metavar="N", help="with --growth: follow none for more than N periods"
    )
    verb.add_argument(
        "--long",
        action="store_true",
        help="with --growth: the one ensemble of 100 million periods instead (an hour or more)",
    )
    verb.add_argument(
        "--outside",
        action="store_true",
        help="with --tradeoff: compiled integrators of other libraries too, each solve a program of "
        "its own that compiles first (a quarter of an hour more)",
    )


def publish(options: argparse.Namespace) -> Answer:
    """Tables from stored verdicts, or the exact trajectories, or what each gate sees."""
    from taylor_verify.cli.claims import publish_claims
    from taylor_verify.cli.growth_publish import publish_growth
    from taylor_verify.studies import report

    anew: dict[str, Callable[[Path], Answer]] = {
        "reference": references,
        "portraits": portraits,
        "gallery": gallery,
        "controls": controls,
        "enclosure": enclosure,
        "claims": publish_claims,
        "prices": prices,
        "reach": reach,
        "tradeoff": partial(tradeoff, outside=options.outside),
        "extremes": extremes,
        "paper": paper,
        "missing": make_missing,
        "worst": partial(worst, seconds=options.seconds, seed=options.seed),
        "growth": partial(publish_growth, periods=options.periods, long=options.long),
    }
    # These make their pages from what the folder holds; all others put something into it.
    measured = anew.keys() - {"gallery", "paper", "missing"}
    # These are exact, and run no solver.
    with_heyoka = measured - {"reference", "claims"}
    folder = reports_folder(
        options.folder, measures=any(getattr(options, option) for option in measured)
    )
    for option, write in anew.items():
        if getattr(options, option):
            if option in with_heyoka:
                _require_heyoka(f"--{option}")
            place = writable(folder, "--from")
            with alone_in(place, "--from"):
                return write(place)
    if options.periods is not None or options.long:
        raise WrongCall("expected --periods and --long with --growth, got them without @ publish")
    if options.site is not None:
        return site(folder, str(writable(options.site, "--site")))
    if options.archive is not None:
        return pack(Path(folder), writable(options.archive, "--archive"))
    if options.outside:
        raise WrongCall("expected --outside with --tradeoff, got it without @ --outside")
    try:
        with alone_in(Path(folder) if Path(folder).is_dir() else None, "--from"):
            return files_written(report.publish(folder))
    except FileNotFoundError as error:
        raise WrongCall(
            f"expected what `run --out {folder}` writes, got no such file @ {error.filename}"
        ) from error
    except ValueError as error:
        raise WrongCall(str(error)) from error


def _require_heyoka(option: str) -> None:
    """Raise WrongCall without heyoka: what is published must not be replaced by rows of nothing."""
    from taylor_verify.solvers.taylor.package import lack

    if (missing := lack()) is not None:
        raise WrongCall(f"{missing} @ {option}")


def references(folder: Path) -> Answer:
    """The exact trajectory of every shipped scene."""
    from taylor_verify.scenes.library import names
    from taylor_verify.studies.reference import page as reference_files
    from taylor_verify.studies.reference.measure import references

    scenes = names()
    documents = references(scenes, counting(len(scenes)))
    return files_written(reference_files.write(folder, documents))


def portraits(folder: Path) -> Answer:
    """What each shipped scene is and how it moves, for pages and pictures."""
    from taylor_verify.scenes.library import names
    from taylor_verify.studies.portraits import stored as files
    from taylor_verify.studies.portraits.measure import portraits

    scenes = names()
    return files_written(files.write(folder, portraits(scenes, counting(len(scenes)))))


def gallery(folder: Path) -> Answer:
    """Pictures of some motions and of their errors, from what the folder holds already."""
    from taylor_verify.studies.gallery import page as pictures

    try:
        return files_written(pictures.write(folder))
    except FileNotFoundError as error:
        raise WrongCall(
            "expected what `run --out`, `publish --reference`, `--controls` and `--portraits` write, "
            f"got no such file @ {error.filename}"
        ) from error
    except ValueError as error:
        raise WrongCall(str(error)) from error


def controls(folder: Path) -> Answer:
    """What each gate sees of broken solvers, and what heyoka does where nobody takes care."""
    from taylor_verify.controls.defects import DEFECTS
    from taylor_verify.studies import report
    from taylor_verify.studies.controls import measure as sight
    from taylor_verify.studies.traps import page as traps
    from taylor_verify.studies.traps import table

    finished = counting(len(DEFECTS) + len(table.TRAPS))
    seen = sight.study(sight.sights(DEFECTS, finished))
    trapped = table.study(table.TRAPS, finished)
    return files_written([*report.publish_controls(folder, seen), *traps.publish(folder, trapped)])


def enclosure(folder: Path) -> Answer:
    """The width of an enclosure beside its true error, stored and drawn."""
    from taylor_verify.studies.enclosure import page as widths
    from taylor_verify.studies.enclosure.measure import study

    return files_written(widths.write(folder, study()))


def prices(folder: Path) -> Answer:
    """What each thing that a scene may ask for costs, measured."""
    from taylor_verify.studies.prices import page as pages
    from taylor_verify.studies.prices.measure import RUNGS, study

    return files_written(pages.write(folder, study(counting(len(RUNGS)))))


def tradeoff(folder: Path, outside: bool) -> Answer:
    """Speed against accuracy on the published scenes, measured in fresh processes."""
    from taylor_verify.studies import report
    from taylor_verify.studies.tradeoff.measurement import measurement

    found = measurement(with_outside=outside, finished=say)
    return files_written(report.publish_tradeoff(folder, found.numbers(), found.times()))


def reach(folder: Path) -> Answer:
    """How far each precision carries in every family of extremes."""
    from taylor_verify.studies.reach import page as pages
    from taylor_verify.studies.reach.measure import members, study

    return files_written(pages.write(folder, study(counting(members()))))


def extremes(folder: Path) -> Answer:
    """Run the extremes on float64; fail where an answer is not the expected one."""
    from taylor_verify.batch.selection import select
    from taylor_verify.cli.progress import advancing
    from taylor_verify.run_many import run_many
    from taylor_verify.scenes.library import EXTREMES
    from taylor_verify.studies.extremes import page as pages
    from taylor_verify.studies.extremes.measure import extremes_study

    with advancing() as progress:
        results = run_many(select([EXTREMES], [_ON]), progress=progress)
    study = extremes_study(results)
    answer = files_written(pages.write(folder, study))
    # An unexpected answer is published too, where it stands out.
    return answer._replace(status=results.exit_status, messages=study.mismatches)


def paper(folder: Path) -> Answer:
    """The pages that are there, as LaTeX and HTML."""
    from taylor_verify.studies import paper as files

    try:
        return files_written(files.write(folder))
    except ImportError as error:
        raise WrongCall(
            f"expected markdown-it-py and latex2mathml, got {error} (pip install them) @ --paper"
        ) from error
    except ValueError as error:
        raise WrongCall(f"{error} (--paper)") from error


def worst(folder: Path, seconds: float, seed: int) -> Answer:
    """The worst error over attainable in each family; its scenes take the place of those kept."""
    from taylor_verify.scenes.library import WORST, cases_directory
    from taylor_verify.studies.worst import page as pages
    from taylor_verify.studies.worst.measure import FAMILIES, hunt, study

    if not 0 < seconds < inf:
        raise WrongCall(f"expected a time in seconds above 0, got {seconds:g} @ --seconds")
    found = hunt(FAMILIES, seconds, seed, counting(len(FAMILIES)))
    scenes = {one.family.name: one.scene_text for one in found}
    kept = pages.keep(cases_directory() / WORST, scenes)
    return files_written([*pages.write(folder, study(found, seconds, seed)), *kept])


def site(folder: str, target: str) -> Answer:
    """The pages that a browser shows, from what the folder holds already."""
    from taylor_verify.records import store

    try:
        from taylor_verify.studies.site.builder import build

        answer = files_written(build(folder, target))
        return answer._replace(messages=missing_from_pages(Path(folder)))
    except ImportError as error:
        raise WrongCall(
            f"expected {error.name} (pip install it), got no such package @ --site"
        ) from error
    except FileNotFoundError as error:
        raise WrongCall(
            f"expected what `run --out {folder}` writes ({store.FOLDER}/{store.VERDICTS} first of all), "
            f"got no such file @ {error.filename}"
        ) from error
    except ValueError as error:
        raise WrongCall(f"{error} @ --site") from error
