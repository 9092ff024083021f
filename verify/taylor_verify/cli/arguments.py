"""The arguments of every verb."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NoReturn

from taylor_verify.cli import (
    check,
    ci,
    claims,
    columns,
    publishing,
    question,
    scene,
    tolerance,
    tradeoff,
    verbs,
)
from taylor_verify.cli.answer import Answer
from taylor_verify.records.version import __version__
from taylor_verify.scenes.names import escaped

_DEFAULT_DIGITS = 30
# What may be meant as a rung, misspelt or not: a scene of such a name is written ./f64.
_RUNG = re.compile(r"(f|mp)\d*", re.IGNORECASE)
_NEGATIVE_TIME = re.compile(r"-[\d.]")


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """The options, ``act`` the function of the verb; SystemExit for --help and a wrong call."""
    parser = _parser("publish" in arguments)
    options, left = parser.parse_known_args(_with_times_attached(arguments))
    scenes = getattr(options, "scenes", None)
    files = getattr(options, "files", None)
    studies = getattr(options, "studies", None)
    if studies is not None:
        # An option that is none is named by the verb, beside what there is: `--growth` was one.
        options.studies, left = [*studies, *left], []
    if left and ((scenes is None and files is None) or any(word.startswith("-") for word in left)):
        parser.error(f"unrecognized arguments: {' '.join(left)}")
    if scenes is not None:
        # argparse gives `--rung` every word up to the next option, and takes scenes in one place.
        options.rung, taken = _split(options.rung)
        options.scenes = [*scenes, *taken, *left]
    if files is not None:
        # Files may stand before and behind the options.
        options.files = [*files, *left]
    return options


def _with_times_attached(arguments: Sequence[str]) -> list[str]:
    """``--at -5,3`` as ``--at=-5,3``: argparse takes a leading minus for an option."""
    attached: list[str] = []
    for word in arguments:
        if attached and attached[-1] == "--at" and _NEGATIVE_TIME.match(word):
            attached[-1] = f"--at={word}"
        else:
            attached.append(word)
    return attached


def _split(groups: Iterable[Sequence[str]] | None) -> tuple[list[str], list[str]]:
    """The rungs and the scenes of all that stood behind ``--rung``, whose first word is a rung."""
    rungs: list[str] = []
    scenes: list[str] = []
    for first, *others in groups or ():
        rungs += first.split(",")
        for word in others:
            names = word.split(",")
            if all(_RUNG.fullmatch(name) for name in names):
                rungs += names
            else:
                scenes.append(word)
    return rungs, scenes


class _Parser(argparse.ArgumentParser):
    """A parser whose message cannot steer the terminal: it repeats words that may be names of files."""

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        super().exit(status, message and escaped(message))


def _parser(is_publishing: bool) -> argparse.ArgumentParser:
    parser = _Parser(
        prog="taylor-verify",
        description="The reference that rigid-body and ideal-fluid simulations are measured "
        "against.",
        epilog="SCENE is a file or the name of a shipped scene, such as euler/generic. "
        "Exit status: 0 pass, 1 a gate failed, 2 the input or the call was wrong, 3 undecided. "
        "`taylor-verify VERB --help` has an example.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"taylor-verify {__version__}")
    found = parser.add_subparsers(title="verbs", metavar="VERB", required=True)
    _add_list(found)
    _add_scene(found)
    _add_question(found)
    _add_run(found)
    _add_exact(found)
    _add_check(found)
    _add_explain(found)
    _add_tradeoff(found)
    _add_claims(found)
    _add_publish(found, is_publishing)
    return parser


def _verb(
    found: Any, name: str, what: str, example: str, act: Callable[[argparse.Namespace], Answer]
) -> argparse.ArgumentParser:
    verb: argparse.ArgumentParser = found.add_parser(
        name,
        help=what,
        description=what[0].upper() + what[1:] + ".",
        epilog=f"example: taylor-verify {example}",
        allow_abbrev=False,
    )
    verb.add_argument("--json", action="store_true", help="print one JSON document on stdout")
    verb.set_defaults(act=act)
    return verb


def _add_list(found: Any) -> None:
    _verb(
        found, "list", "list the shipped scenes, solvers and rungs", "list --json", verbs.list_all
    )


def _add_scene(found: Any) -> None:
    what = "write a scene from a URDF, SDF or MJCF file"
    scene.add_options(_verb(found, "scene", what, "scene from robot.urdf --link base", scene.scene))


def _add_question(found: Any) -> None:
    what = "print a scene as any solver gets it, in exact text and hexadecimal floats"
    example = "question euler/generic --csv"
    verb = _verb(found, "question", what, example, question.question)
    verb.add_argument("scene", metavar="SCENE")
    verb.add_argument("--rung", default="f64", metavar="R", help="default: f64")
    verb.add_argument(
        "--csv",
        action="store_true",
        help="print the header and the times of a trajectory file, for a program to fill in",
    )


def _add_run(found: Any) -> None:
    what = "solve scenes, compare with the exact motion, judge"
    verb = _verb(found, "run", what, "run euler/generic --rung f32 f64", verbs.run)
    verb.add_argument(
        "scenes",
        nargs="*",
        metavar="SCENE",
        help="a folder of shipped scenes (extremes) is all of them; default: the standard set",
    )
    verb.add_argument("--solver", default="taylor", metavar="S", help="default: taylor")
    verb.add_argument(
        "--rung",
        nargs="+",
        action="append",
        metavar="R",
        help="f32 f64 f80 f128 mpN; default: f64 for named scenes, all five for the standard set",
    )
    verb.add_argument(
        "--jobs", type=int, metavar="N", help="processes for several scenes; default: one a core"
    )
    verb.add_argument("--out", metavar="DIR", help="write verdicts, records and tables there")
    verb.add_argument(
        "--resume",
        action="store_true",
        help="go on where the last run of several scenes was interrupted",
    )
    verb.add_argument(
        "--against",
        metavar="DIR",
        help="fail if a number has left the rounding class of the one published there",
    )
    tolerance.add_option(verb)
    ci.add_options(verb)


def _add_exact(found: Any) -> None:
    what = "print the exact motion of a scene at the times given"
    verb = _verb(found, "exact", what, "exact euler/generic --at 0,10,1e9 --digits 40", verbs.exact)
    verb.add_argument("scene", metavar="SCENE")
    verb.add_argument("--at", required=True, metavar="T,T,...", help="decimals or a/b, absolute")
    verb.add_argument(
        "--digits", type=int, default=_DEFAULT_DIGITS, metavar="N", help="default: 30"
    )
    verb.add_argument(
        "--route",
        choices=("arb", "mpmath", "taylor"),
        help="arb, the closed form in balls (default where there is one); mpmath, the same by other "
        "formulas; taylor, Taylor series in balls (default elsewhere)",
    )


def _add_check(found: Any) -> None:
    what = "judge somebody's trajectory: CSV, NPZ, Parquet or JSON; of several files the order too"
    verb = _verb(
        found, "check", what, "check mine.csv --scene euler/generic --rung f64", check.check
    )
    verb.add_argument(
        "files",
        nargs="+",
        metavar="FILE",
        help=f"{columns.FILE}; several are of one solver at several steps",
    )
    columns.add_option(verb)
    verb.add_argument(
        "--scene", required=True, metavar="SCENE", help="what the file is an answer to"
    )
    verb.add_argument(
        "--rung",
        default="f64",
        metavar="R",
        help="precision of the arithmetic that made the file; default: f64",
    )
    verb.add_argument(
        "--accept-conventions",
        action="store_true",
        help="correct what was found out (order of the quaternion, axes, units, time, ...) and judge "
        "the rest; without it the file is judged as it stands",
    )
    verb.add_argument(
        "--partial",
        action="store_true",
        help="judge what the file has, without undecided for tracked columns or a part of the span that "
        "it lacks",
    )
    tolerance.add_option(verb)
    check.add_options(verb)
    ci.add_options(verb)


def _add_explain(found: Any) -> None:
    what = "show the equations as built, the regime of the orbit and the arithmetic of each gate"
    verb = _verb(found, "explain", what, "explain kirchhoff/screw --rung f80", verbs.explain)
    verb.add_argument("scene", metavar="SCENE")
    verb.add_argument("--rung", default="f64", metavar="R", help="default: f64")


def _add_tradeoff(found: Any) -> None:
    what = "measure the time and the error of every setting of every solver"
    example = "tradeoff euler/generic --rung f64 --target 1e-9"
    verb = _verb(found, "tradeoff", what, example, tradeoff.tradeoff)
    verb.add_argument("scenes", nargs="*", metavar="SCENE")
    verb.add_argument(
        "--target",
        metavar="E",
        help="also find the fastest setting whose error stays below E on the scene and on starts "
        "nearby; exit status 3 where there is none",
    )
    verb.add_argument(
        "--rung", nargs="+", action="append", metavar="R", help="default: f32 f64 f80 f128"
    )
    verb.add_argument(
        "--solver",
        action="append",
        metavar="S",
        help="measure this setting of a solver and no others but taylor's, which are the yardstick; "
        'may be repeated: --solver "process:./mine" --solver "geometric:splitting?step=0.01"',
    )
    verb.add_argument(
        "--outside",
        action="store_true",
        help="measure the integrators of other libraries too, each in an environment of its own, "
        "which is made the first time (a download)",
    )
    verb.add_argument(
        "--cold",
        action="store_true",
        help="also start each setting in a new process with nothing compiled, and tell importing, "
        "compiling and solving apart",
    )
    verb.add_argument(
        "--repeats", type=int, default=5, metavar="N", help="timed solves of a setting; default: 5"
    )
    verb.add_argument(
        "--seed", type=int, default=1, metavar="N", help="of the order and the starts; default: 1"
    )
    verb.add_argument(
        "--out", metavar="DIR", help="write the numbers and the work-precision pictures there"
    )


def _add_claims(found: Any) -> None:
    what = "check every numbered equation and every claim of the two source texts"
    example = 'claims "hydromechanics 49 (17)"'
    verb = _verb(found, "claims", what, example, claims.claims)
    verb.add_argument(
        "ids",
        nargs="*",
        metavar="ID",
        help='"heinbockel (2.2.70)", its number "(2.2.70)", or a whole text: "hydromechanics 48"; '
        "default: all",
    )


def _add_publish(found: Any, is_publishing: bool) -> None:
    what = "measure and write what is published, or make its pages of what is stored"
    verb = _verb(found, "publish", what, "publish growth --periods 1e4", publishing.publish)
    publishing.add_options(verb, is_publishing)
