"""The arguments of every verb, read by argparse, and the module that answers it.

That module is imported when its verb is called, so that `--help` needs nothing heavy. The arguments of
a verb are a text: a line for each, with its help two blanks behind it, which goes on below.

    --csv           an option without a value        --link NAME       one with a value
    --jobs N        a whole number                   --rung R [f64]    with a default
    --scene! SCENE  it must be given                 --solver* S       it may be repeated
    --rung+ R       with several values as well      --route arb|mpmath  one of these words
    link NAME       no option                        files+ FILE       at least one (*: any number)
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Iterable, Sequence
from functools import partial
from importlib import import_module
from typing import Final

from taylor_verify.cli.answer import Answer
from taylor_verify.cli.parser import Parser, add_argument, near_word, unknown_words
from taylor_verify.cli.verbs import OWN_PACKAGE, add, described, verbs
from taylor_verify.records.plugins import package_of
from taylor_verify.records.version import __version__

_VERB: Final = "VERB"
COLOURS: Final = ("auto", "always", "never")
# Of the verbs that our second package adds, those that publish are not on the first page of help.
_LISTED: Final = {"board": "show the boards of engines, and put one of yours on them"}
# Words that count as rungs, even if misspelt: a scene with such a name is written ./f64.
_RUNG_NAME = re.compile(r"(f|mp)\d*", re.IGNORECASE)
_NEGATIVE_TIME = re.compile(r"-[\d.]")


_SCENE: Final = "SCENE  a scene file, or the name of a shipped scene (`taylor-verify list`)"
_RUNG: Final = (
    "--rung R [f64]  the precision: f32, f64, f80, f128, or mpN with N bits; default: f64"
)
_RUNG_OF_FILES: Final = (
    "--rung R [f64]  the precision in which the files were computed; default: f64"
)
_SOLVER: Final = "--solver S [taylor]  the solver to judge (`taylor-verify list`); default: taylor"
_TOLERANCE: Final = """
--tolerance E  allow this error in place of the error that rounding explains; it is relative, and in
  radians for the attitude: 1e-8 for all quantities, or omega=1e-8,T=1e-10 for some
"""
_CI: Final = """
--explain  also show how each bound was computed
--junit FILE  write the verdicts to FILE as JUnit XML
--github  print annotations for GitHub on stderr, and write a summary to the file $GITHUB_STEP_SUMMARY
--baseline FILE  fail if a row is worse than in FILE, by more than rounding explains; FILE is the output of
  an earlier --json, or verdicts.json of an earlier `run --out`
--gate bound|baseline [bound]  what decides the exit status: the bounds (and --baseline besides), or the
  baseline alone, for an answer that is beyond its bounds and must not get worse; default: bound
"""
OWN_VERBS: Final = {
    "list": (
        "list the shipped scenes, families, solvers, precisions and file formats",
        "list --json",
        "--schema  print the JSON schema of what `run --json` and `check --json` print",
    ),
    "scene": (
        "write a scene from a URDF, SDF or MJCF file",
        "scene from robot.urdf --link base",
        """
source from  the word `from`
file FILE  a URDF, SDF or MJCF file
--link NAME  the link or body to take; default: the only one that has an inertia
--out FILE  write the scene to FILE, which must not exist yet; default: print it
""",
    ),
    "question": (
        "print a scene as a solver gets it: JSON with exact text and hexadecimal floats",
        "question euler/generic --csv",
        f"""
scene {_SCENE}
{_RUNG}
--csv  print a trajectory file to fill in: its header and its times
""",
    ),
    "run": (
        "solve scenes, compare the answers with the exact motion, and judge them",
        "run euler/generic --rung f32 f64",
        f"""
scenes* SCENE  scene files, names of shipped scenes, patterns ('euler/*') or folders of shipped scenes
  (extremes); default: the standard set
{_SOLVER}
--rung+ R  the precisions: f32, f64, f80, f128, or mpN with N bits; default: f64 for named scenes, five
  precisions for the standard set
--jobs N  the number of processes for several scenes; default: one for each core
--out DIR  write verdicts, records and tables to DIR
--resume  go on where the same run of several scenes was interrupted
--against DIR  fail if an error differs by more than a factor of ten from that in DIR, a folder of an
  earlier `run --out`
{_TOLERANCE}{_CI}""",
    ),
    "exact": (
        "print the exact motion of a scene at the times given",
        "exact euler/generic --at 0,10,1e9 --digits 40",
        f"""
scene {_SCENE}
--at* T,T,...  the times: decimals or a/b, in any order, on the clock of the scene; may be repeated
--event TEXT  in place of --at: all times of "w2 = 0", "extremum r33" or the like, by the names of loads
--until T  the end of the span of --event, from the start of the scene
--digits N [30]  the number of significant digits; default: 30
--route arb|mpmath|taylor  how to compute: arb, the closed form with proven error bounds (default where
  there is one); mpmath, the same by other formulas; taylor, Taylor series with proven error bounds
  (default elsewhere)
--attitude matrix|quaternion|zyx [matrix]  R row by row (default), q0 q1 q2 q3, or yaw pitch roll in rad
""",
    ),
    "check": (
        "judge a trajectory file (CSV, JSON, NPZ, Parquet, HDF5, ...), or several of one solver",
        "check mine.csv --scene euler/generic --rung f64",
        f"""
files+ FILE  a trajectory with a column t and any of: w1 w2 w3 (angular velocity, body axes); u1 u2 u3
  (velocity of the body's origin, body axes; with w1 w2 w3 in place of the impulses); x1 x2 x3 y1 y2 y3
  (impulses, body axes); q0 q1 q2 q3 (scalar first, body to space) or r11 ... r33; c1 c2 c3 (centre, space
  axes). Usual other names (time, wx, omega_x, qw, p q r) and units such as [ms] or [deg/s] are recognised,
  and a note says so. All other columns are ignored, and a note names them. `-` is standard input. Several
  files are the answers of one solver at several steps: their order of convergence is shown too
--columns* NAME=THEIRS,...  THEIRS is the file's column for NAME, a name above or a group (omega=gyro); or
  its first and last one (zyx_deg=5:7, mrp=2:4, rotvec=2:4); commas are part of it unless NAME= follows
--scene! SCENE  the scene that the file answers: a scene file, or the name of a shipped scene
{_RUNG_OF_FILES}
--event TEXT  judge the column or list `events` of the file, times of "w2 = 0" or the like, not its states
--accept-conventions  correct the conventions that the file does not share with the scene (order of the
  quaternion, axes, units, time, ...), then judge; without this option the file is judged as it stands
--partial  accept a file that lacks tracked columns or a part of the time; without this option the answer
  to such a file is undecided
{_TOLERANCE}
--steps H,H,...  the steps of several files, in their order; default: what the files or their names say
  (run_h0.05.csv)
--knob NAME  order several files by another number of their names: --knob rtol for run_rtol1e-6.csv
{_CI}""",
    ),
    "certify": (
        "bound the error of a dense answer for all times",
        "certify dense.json --scene euler/generic --tolerance 1e-6",
        """file FILE  pieces {"breaks": [..], "quantities": {"omega": [[[c0, c1, ..], ..], ..]}}, or samples
--scene! SCENE  the scene that the file answers
--tolerance E  the error that is allowed, as in `check`
--interpolation linear|cubic|hermite  what the program of the file makes of its samples
--columns* NAME=THEIRS,...  THEIRS is the column of samples for NAME, as in `check`
""",
    ),
    "explain": (
        "show the equations of a scene, its orbit in numbers, and how each bound is computed",
        "explain kirchhoff/screw --rung f80",
        f"scene {_SCENE}\n{_RUNG}",
    ),
    "tradeoff": (
        "measure the time and the error of every setting of every solver",
        "tradeoff euler/generic --rung f64 --target 1e-9",
        """
scenes* SCENE  scene files, names of shipped scenes, patterns or folders of shipped scenes
--target E  also find the fastest setting whose error stays below E on the scene and on starts nearby;
  exit status 3 if there is none
--rung+ R  the precisions: f32, f64, f80, f128, or mpN with N bits; default: f32 f64 f80 f128
--solver* S  measure this solver, and beside it only taylor, the yardstick; may be repeated:
  --solver "process:./mine" --solver "geometric:splitting?step=0.01"
--outside  also measure the integrators of other libraries, each in an environment of its own, which is
  downloaded the first time
--repeats N [5]  how often each setting is timed; default: 5
--seed N [1]  the seed of the order and of the starts; default: 1
--out DIR  write the numbers and the pictures to DIR (needs matplotlib)
""",
    ),
    "sweep": (
        "solve and judge many bodies and starts, drawn from a family",
        "sweep satellites --count 1000 --seed 1 --out swept",
        f"""
what FAMILY  a shipped family (`taylor-verify list`), a template (a scene file in which numbers are drawn),
  or a folder of scenes
--count N  how many points are drawn; default: what the template says, else 100
--seed N  the seed of the points; default: what the template says, else 1; point k of a seed is always the
  same
--points random|sobol  how the points are spread; default: what the template says, else random
{_SOLVER}
{_RUNG}
{_TOLERANCE.strip()}
--executor E [local]  local, or dask:ADDRESS of a dask scheduler; default: local
--jobs N  the number of processes on this machine; default: one for each core
--out DIR  write the rows (Parquet), a summary and the worst cases to DIR
--resume  go on with an interrupted sweep in the folder of --out
--worst N [10]  how many of the worst cases are written as scenes; default: 10
""",
    ),
    "draw": (
        "draw the exact motion of a scene, and the errors of trajectory files",
        "draw euler/tennis-racket --animate --out racket.html",
        f"""
scene {_SCENE}
files* FILE  trajectory files, read as `check` reads them: their errors are drawn against time
--out NAME  write NAME-polhode.svg and so on; the ending of NAME says the format: .svg (default), .pdf, .png
--only NAME,...  draw only these: polhode, time, axis, spheres, path, errors, load;
  a single picture is written to the file of --out itself
--animate  draw one moving picture: a page that turns and needs no network (--out NAME.html)
{_RUNG_OF_FILES}
--columns* NAME=THEIRS,...  THEIRS is the file's column for NAME, as in `check`
--accept-conventions  correct the conventions of the files before their errors are drawn, as in `check`
""",
    ),
}


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Return the options, with the function of the verb as ``act``.

    Raises SystemExit for --help and for a wrong call.
    """
    parser = _parser(arguments)
    try:
        options, left = parser.parse_known_args(_with_times_attached(arguments))
    except argparse.ArgumentError as error:
        parser.error(_unknown_verb(arguments) if error.argument_name == _VERB else str(error))
    # argparse makes an empty list of the value in --at=--.
    for option, _, value in (word.partition("=") for word in arguments):
        if option.startswith("--") and value == "--":
            options.verb.error(f"expected a value, got -- @ {option}")
    if options.act is _GREET and ("CI" in os.environ or not sys.stdout.isatty()):
        parser.error(f"expected a verb, got none ({', '.join(OWN_VERBS)})")
    scenes = getattr(options, "scenes", None)
    files = getattr(options, "files", None)
    if hasattr(options, "unknown"):
        # A verb of a plug-in may name an unknown word itself, beside what there is.
        options.unknown, left = left, []
    if left and ((scenes is None and files is None) or any(word.startswith("-") for word in left)):
        options.verb.error(unknown_words(left, options.verb))
    if scenes is not None:
        # argparse gives `--rung` every word up to the next option, and takes scenes in one place.
        options.rung, taken = _split(options.rung)
        options.scenes = [*scenes, *taken, *left]
    if files is not None:
        # Files may stand before and behind the options.
        options.files = [*files, *left]
    return options


def _unknown_verb(arguments: Sequence[str]) -> str:
    """Return the message for a first word that is no verb, with those that are near to it."""
    word = next(word for word in arguments if not word.startswith("-"))
    known = [*OWN_VERBS, *(verb.name for verb in verbs(OWN_VERBS))]
    return f"expected a verb, got {word} ({near_word(word, known, '`taylor-verify --help` names them')})"


def _with_times_attached(arguments: Sequence[str]) -> list[str]:
    """Write ``--at -5,3`` as ``--at=-5,3``: argparse takes a leading minus for an option."""
    attached: list[str] = []
    for word in arguments:
        if attached and attached[-1] in ("--at", "--until") and _NEGATIVE_TIME.match(word):
            attached[-1] += f"={word}"
        else:
            attached.append(word)
    return attached


def _split(groups: Iterable[Sequence[str]] | None) -> tuple[list[str], list[str]]:
    """Return the rungs and the scenes among the words behind each ``--rung``; its first word is a rung."""
    rungs: list[str] = []
    scenes: list[str] = []
    for first, *others in groups or ():
        rungs += first.split(",")
        for word in others:
            names = word.split(",")
            if all(_RUNG_NAME.fullmatch(name) for name in names):
                rungs += names
            else:
                scenes.append(word)
    return rungs, scenes


def _parser(words: Sequence[str]) -> argparse.ArgumentParser:
    """Return the parser; verbs of other packages are loaded if they are among the words."""
    parser = Parser(
        prog="taylor-verify",
        description="Find out how wrong a simulation is: of a rigid body, or of a solid in an ideal "
        "fluid. Its numbers are compared with the exact motion.",
        epilog="SCENE is a file or the name of a shipped scene, such as euler/generic. "
        "Exit status: 0 all is right, 1 something is wrong, 2 the input or the call was wrong, "
        "3 undecided. `taylor-verify VERB --help` has an example.",
        allow_abbrev=False,
        # `parse` reports a wrong verb, with the verbs that are near to it.
        exit_on_error=False,
    )
    parser.add_argument("--version", action="version", version=f"taylor-verify {__version__}")
    parser.set_defaults(act=_GREET, verb=parser, json=False, quiet=False, color=COLOURS[0])
    own = parser.add_subparsers(title="verbs", metavar=_VERB)
    for name, (what, example, arguments) in OWN_VERBS.items():
        verb = _verb_parser(own, name, what, example)
        verb.set_defaults(act=partial(_act, name))
        for line in arguments.replace("\n  ", " ").split("\n"):
            if line:
                add_argument(verb, line)
    first = next((word for word in words if not word.startswith("-")), "")
    # The packages of this environment are asked for verbs only if none of ours is called: that takes time.
    for plugged in verbs(OWN_VERBS) if first not in OWN_VERBS else ():
        if plugged.name == first:
            add(_verb_parser(own, plugged.name, *described(plugged)), plugged)
        elif plugged.name in _LISTED:
            own.add_parser(plugged.name, help=_LISTED[plugged.name])
        elif package_of(plugged) == OWN_PACKAGE:
            own.add_parser(plugged.name)
        else:
            own.add_parser(plugged.name, help=f"a verb of the package {package_of(plugged)}")
    return parser


def _verb_parser(
    verbs: argparse._SubParsersAction[Parser], name: str, what: str, example: str
) -> argparse.ArgumentParser:
    """Return the parser of a verb, with what every verb has."""
    verb = verbs.add_parser(
        name,
        help=what,
        description=what[:1].upper() + what[1:] + ".",
        epilog=f"example: taylor-verify {example}" if example else None,
        allow_abbrev=False,
    )
    verb.add_argument("--json", action="store_true", help="print one JSON document on stdout")
    verb.add_argument(
        "-q",
        "--quiet",
        action="store_true",
        help="print the last line alone, below what failed",
    )
    verb.add_argument(
        "--color",
        choices=COLOURS,
        default=COLOURS[0],
        help="when to print in colours; default: auto",
    )
    verb.set_defaults(verb=verb)
    return verb


def _act(name: str, options: argparse.Namespace) -> Answer:
    """Import the module of a verb and let it answer."""
    answer: Answer = import_module(f"taylor_verify.cli.{name}").answer(options)
    return answer


# The answer to a call without a verb.
_GREET: Final = partial(_act, "greeting")
