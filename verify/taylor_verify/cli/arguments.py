"""The arguments of every verb, and the module that answers it.

That module is imported when its verb is called, so that `--help` needs nothing heavy.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from importlib import import_module
from typing import Any, Final, NoReturn

from taylor_verify.cli import publishing
from taylor_verify.cli.answer import Answer
from taylor_verify.records.version import __version__
from taylor_verify.scenes.names import escaped

# What may be meant as a rung, misspelt or not: a scene of such a name is written ./f64.
_RUNG = re.compile(r"(f|mp)\d*", re.IGNORECASE)
_NEGATIVE_TIME = re.compile(r"-[\d.]")
_COLUMNS: Final = (
    "columns t and any of w1 w2 w3 (angular velocity, body axes); u1 u2 u3 (velocity of the body's origin, "
    "body axes; with w it stands for the impulses); x1 x2 x3 y1 y2 y3 (impulses, body axes); q0 q1 q2 q3 "
    "(scalar first, body to space) or r11 ... r33; c1 c2 c3 (centre, space axes). Usual other names (time, "
    "wx, omega_x, qw, p q r) and units such as [ms] or [deg/s] are taken and said; all other columns are "
    "ignored, and named"
)


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Return the options, with the function of the verb as ``act``.

    Raises SystemExit for --help and for a wrong call.
    """
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
    """Write ``--at -5,3`` as ``--at=-5,3``: argparse takes a leading minus for an option."""
    attached: list[str] = []
    for word in arguments:
        if attached and attached[-1] == "--at" and _NEGATIVE_TIME.match(word):
            attached[-1] = f"--at={word}"
        else:
            attached.append(word)
    return attached


def _split(groups: Iterable[Sequence[str]] | None) -> tuple[list[str], list[str]]:
    """Tell rungs from scenes in all that stood behind ``--rung``, whose first word is a rung."""
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

    def value(self, name: str, metavar: str, said: str | None = None, **more: Any) -> None:
        """Add an argument that has a value."""
        self.add_argument(name, metavar=metavar, help=said, **more)

    def flag(self, name: str, said: str) -> None:
        """Add an option that has no value."""
        self.add_argument(name, action="store_true", help=said)


def _parser(is_publishing: bool) -> _Parser:
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
    for name, (what, example, add_options) in _VERBS.items():
        verb = found.add_parser(
            name,
            help=what,
            description=what[0].upper() + what[1:] + ".",
            epilog=f"example: taylor-verify {example}",
            allow_abbrev=False,
        )
        verb.flag("--json", "print one JSON document on stdout")
        verb.set_defaults(act=partial(_act, name))
        if add_options is not None:
            add_options(verb)
    verb.set_defaults(act=publishing.publish)
    publishing.add_options(verb, is_publishing)
    return parser


def _act(name: str, options: argparse.Namespace) -> Answer:
    """Import the module of a verb and let it answer."""
    found: Answer = import_module(f"taylor_verify.cli.{name}").answer(options)
    return found


def _add_scene(verb: _Parser) -> None:
    verb.value("source", "from", "the word `from`", choices=("from",))
    verb.value("file", "FILE", "a URDF, SDF or MJCF file")
    verb.value("--link", "NAME", "the link or body; without it, the only one with an inertia")
    verb.value("--out", "FILE", "write the scene there, to a file that is not there yet")


def _add_question(verb: _Parser) -> None:
    verb.value("scene", "SCENE")
    verb.value("--rung", "R", "default: f64", default="f64")
    verb.flag(
        "--csv",
        "print the header and the times of a trajectory file, for a program to fill in",
    )


def _add_run(verb: _Parser) -> None:
    verb.value(
        *("scenes", "SCENE"),
        "a folder of shipped scenes (extremes) is all of them; default: the standard set",
        nargs="*",
    )
    verb.value("--solver", "S", "default: taylor", default="taylor")
    _add_rungs(
        verb, "f32 f64 f80 f128 mpN; default: f64 for named scenes, all five for the standard set"
    )
    verb.value("--jobs", "N", "processes for several scenes; default: one a core", type=int)
    verb.value("--out", "DIR", "write verdicts, records and tables there")
    verb.flag("--resume", "go on where the last run of several scenes was interrupted")
    verb.value(
        *("--against", "DIR"),
        "fail if a number has left the rounding class of the one published there",
    )
    _add_tolerance(verb)
    _add_ci(verb)


def _add_rungs(verb: _Parser, said: str) -> None:
    verb.value("--rung", "R", said, nargs="+", action="append")


def _add_tolerance(verb: _Parser) -> None:
    verb.value(
        *("--tolerance", "E"),
        "allow this error in place of what rounding leaves: relative, and radians for the attitude; "
        "1e-8 for all quantities, or omega=1e-8,T=1e-10 for some",
    )


def _add_ci(verb: _Parser) -> None:
    """Add the options of every verb whose answer is verdicts."""
    verb.flag("--explain", "show the arithmetic of every bound as well")
    verb.value("--junit", "FILE", "write the verdicts there as JUnit XML")
    verb.flag(
        "--github",
        "annotations for GitHub on stderr, and a summary to the file $GITHUB_STEP_SUMMARY",
    )
    verb.value(
        *("--baseline", "FILE"),
        "fail if a row is worse than in that document of --json (or verdicts.json of --out) "
        "by more than rounding explains",
    )
    verb.add_argument(
        "--gate",
        choices=("bound", "baseline"),
        default="bound",
        help="what decides the exit status: the bounds (and --baseline besides), or the baseline alone, so "
        "that an answer beyond its bounds is kept from getting worse; default: bound",
    )


def _add_exact(verb: _Parser) -> None:
    verb.value("scene", "SCENE")
    verb.value("--at", "T,T,...", "decimals or a/b, absolute", required=True)
    verb.value("--digits", "N", "default: 30", type=int, default=30)
    verb.add_argument(
        "--route",
        choices=("arb", "mpmath", "taylor"),
        help="arb, the closed form in balls (default where there is one); mpmath, the same by other "
        "formulas; taylor, Taylor series in balls (default elsewhere)",
    )


def _add_check(verb: _Parser) -> None:
    verb.value(
        "files", "FILE", f"{_COLUMNS}; several are of one solver at several steps", nargs="+"
    )
    verb.value(
        *("--columns", "NAME=THEIRS,..."),
        "the file's column for a name above, or for a group (omega=gyro); a comma belongs to THEIRS "
        "unless NAME= follows it; may be repeated: --columns 't=Time [ms],w1=rate, axis 1'",
        action="append",
    )
    verb.value("--scene", "SCENE", "what the file is an answer to", required=True)
    verb.value(
        *("--rung", "R"),
        "precision of the arithmetic that made the file; default: f64",
        default="f64",
    )
    verb.flag(
        "--accept-conventions",
        "correct what was found out (order of the quaternion, axes, units, time, ...) and judge "
        "the rest; without it the file is judged as it stands",
    )
    verb.flag(
        "--partial",
        "judge what the file has, without undecided for tracked columns or a part of the span that "
        "it lacks",
    )
    _add_tolerance(verb)
    verb.value(
        *("--steps", "H,H,..."),
        "the step of each of several files, for the order of convergence; default: what the files or "
        "their names say (run_h0.05.csv)",
    )
    verb.value(
        *("--picture", "FILE"),
        "draw the errors of several files against their steps (svg, pdf, png; matplotlib)",
    )
    _add_ci(verb)


def _add_explain(verb: _Parser) -> None:
    verb.value("scene", "SCENE")
    verb.value("--rung", "R", "default: f64", default="f64")


def _add_tradeoff(verb: _Parser) -> None:
    verb.value("scenes", "SCENE", nargs="*")
    verb.value(
        *("--target", "E"),
        "also find the fastest setting whose error stays below E on the scene and on starts "
        "nearby; exit status 3 where there is none",
    )
    _add_rungs(verb, "default: f32 f64 f80 f128")
    verb.value(
        *("--solver", "S"),
        "measure this setting of a solver and no others but taylor's, which are the yardstick; "
        'may be repeated: --solver "process:./mine" --solver "geometric:splitting?step=0.01"',
        action="append",
    )
    verb.flag(
        "--outside",
        "measure the integrators of other libraries too, each in an environment of its own, "
        "which is made the first time (a download)",
    )
    verb.flag(
        "--cold",
        "also start each setting in a new process with nothing compiled, and tell importing, "
        "compiling and solving apart",
    )
    verb.value("--repeats", "N", "timed solves of a setting; default: 5", type=int, default=5)
    verb.value("--seed", "N", "of the order and the starts; default: 1", type=int, default=1)
    verb.value("--out", "DIR", "write the numbers and the work-precision pictures there")


def _add_claims(verb: _Parser) -> None:
    verb.value(
        *("ids", "ID"),
        '"heinbockel (2.2.70)", its number "(2.2.70)", or a whole text: "hydromechanics 48"; '
        "default: all",
        nargs="*",
    )


# Of each verb: what it does, an example, and its options. The last one, publish, has its own.
_VERBS: Final[dict[str, tuple[str, str, Callable[[_Parser], None] | None]]] = {
    "list": ("list the shipped scenes, solvers and rungs", "list --json", None),
    "scene": (
        "write a scene from a URDF, SDF or MJCF file",
        "scene from robot.urdf --link base",
        _add_scene,
    ),
    "question": (
        "print a scene as any solver gets it, in exact text and hexadecimal floats",
        "question euler/generic --csv",
        _add_question,
    ),
    "run": (
        "solve scenes, compare with the exact motion, judge",
        "run euler/generic --rung f32 f64",
        _add_run,
    ),
    "exact": (
        "print the exact motion of a scene at the times given",
        "exact euler/generic --at 0,10,1e9 --digits 40",
        _add_exact,
    ),
    "check": (
        "judge somebody's trajectory: CSV, NPZ, Parquet or JSON; of several files the order too",
        "check mine.csv --scene euler/generic --rung f64",
        _add_check,
    ),
    "explain": (
        "show the equations as built, the regime of the orbit and the arithmetic of each gate",
        "explain kirchhoff/screw --rung f80",
        _add_explain,
    ),
    "tradeoff": (
        "measure the time and the error of every setting of every solver",
        "tradeoff euler/generic --rung f64 --target 1e-9",
        _add_tradeoff,
    ),
    "claims": (
        "check every numbered equation and every claim of the two source texts",
        'claims "hydromechanics 49 (17)"',
        _add_claims,
    ),
    "publish": (
        "measure and write what is published, or make its pages of what is stored",
        "publish growth --periods 1e4",
        None,
    ),
}
