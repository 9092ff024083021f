"""The arguments of every verb, read by argparse, and the module that answers it.

That module is imported when its verb is called, so that `--help` needs nothing heavy. The arguments of
a verb are a text: a line for each, with its help two blanks behind it, which goes on below.

    --csv           an option without a value        --link NAME       one with a value
    --jobs N        a whole number                   --rung R [f64]    with a default
    --at! T,T,...   it must be given                 --solver* S       it may be repeated
    --rung+ R       with several values as well      --route arb|mpmath  one of these words
    link NAME       no option                        files+ FILE       at least one (*: any number)
"""

from __future__ import annotations

import argparse
import difflib
import re
from collections.abc import Iterable, Sequence
from functools import partial
from importlib import import_module
from typing import Any, Final, NoReturn

from taylor_verify.cli import publishing
from taylor_verify.cli.answer import Answer
from taylor_verify.cli.completion import SHELLS
from taylor_verify.records.version import __version__
from taylor_verify.scenes.names import escaped

_VERB: Final = "VERB"
# Words that count as rungs, even if misspelt: a scene with such a name is written ./f64.
_RUNG = re.compile(r"(f|mp)\d*", re.IGNORECASE)
_NEGATIVE_TIME = re.compile(r"-[\d.]")
# Name, sign, value, default and help of an argument.
_ARGUMENT: Final = re.compile(r"([-\w]+)([!*+]?)(?: ([^ ]+))?(?: \[(.+?)\])?(?:  (.*))?")

_TOLERANCE: Final = """
--tolerance E  allow this error in place of what rounding leaves: relative, and radians for the attitude;
  1e-8 for all quantities, or omega=1e-8,T=1e-10 for some
"""
_CI: Final = """
--explain  show the arithmetic of every bound as well
--junit FILE  write the verdicts there as JUnit XML
--github  annotations for GitHub on stderr, and a summary to the file $GITHUB_STEP_SUMMARY
--baseline FILE  fail if a row is worse than in that document of --json (or verdicts.json of --out) by
  more than rounding explains
--gate bound|baseline [bound]  what decides the exit status: the bounds (and --baseline besides), or the
  baseline alone, so that an answer beyond its bounds is kept from getting worse; default: bound
"""
_VERBS: Final = {
    "list": ("list the shipped scenes, solvers and rungs", "list --json", ""),
    "scene": (
        "write a scene from a URDF, SDF or MJCF file",
        "scene from robot.urdf --link base",
        """
source from  the word `from`
file FILE  a URDF, SDF or MJCF file
--link NAME  the link or body; without it, the only one with an inertia
--out FILE  write the scene there, to a file that is not there yet
""",
    ),
    "question": (
        "print a scene as any solver gets it, in exact text and hexadecimal floats",
        "question euler/generic --csv",
        """
scene SCENE
--rung R [f64]  default: f64
--csv  print the header and the times of a trajectory file, for a program to fill in
""",
    ),
    "run": (
        "solve scenes, compare with the exact motion, judge",
        "run euler/generic --rung f32 f64",
        f"""
scenes* SCENE  a folder of shipped scenes (extremes) is all of them; default: the standard set
--solver S [taylor]  default: taylor
--rung+ R  f32 f64 f80 f128 mpN; default: f64 for named scenes, all five for the standard set
--jobs N  processes for several scenes; default: one a core
--out DIR  write verdicts, records and tables there
--resume  go on where the last run of several scenes was interrupted
--against DIR  fail if a number has left the rounding class of the one published there
{_TOLERANCE}{_CI}""",
    ),
    "exact": (
        "print the exact motion of a scene at the times given",
        "exact euler/generic --at 0,10,1e9 --digits 40",
        """
scene SCENE
--at! T,T,...  decimals or a/b, absolute
--digits N [30]  default: 30
--route arb|mpmath|taylor  arb, the closed form in balls (default where there is one); mpmath, the same
  by other formulas; taylor, Taylor series in balls (default elsewhere)
""",
    ),
    "check": (
        "judge somebody's trajectory: CSV, NPZ, Parquet or JSON; of several files the order too",
        "check mine.csv --scene euler/generic --rung f64",
        f"""
files+ FILE  columns t and any of w1 w2 w3 (angular velocity, body axes); u1 u2 u3 (velocity of the
  body's origin, body axes; with w it stands for the impulses); x1 x2 x3 y1 y2 y3 (impulses, body axes);
  q0 q1 q2 q3 (scalar first, body to space) or r11 ... r33; c1 c2 c3 (centre, space axes). Usual other
  names (time, wx, omega_x, qw, p q r) and units such as [ms] or [deg/s] are taken and said; all other
  columns are ignored, and named; several are of one solver at several steps
--columns* NAME=THEIRS,...  the file's column for a name above, or for a group (omega=gyro); a comma
  belongs to THEIRS unless NAME= follows it; may be repeated: --columns 't=Time [ms],w1=rate, axis 1'
--scene! SCENE  what the file is an answer to
--rung R [f64]  precision of the arithmetic that made the file; default: f64
--accept-conventions  correct what was found out (order of the quaternion, axes, units, time, ...) and
  judge the rest; without it the file is judged as it stands
--partial  judge what the file has, without undecided for tracked columns or a part of the span that it
  lacks
{_TOLERANCE}
--steps H,H,...  the step of each of several files, for the order of convergence; default: what the
  files or their names say (run_h0.05.csv)
--picture FILE  draw the errors of several files against their steps (svg, pdf, png; matplotlib)
{_CI}""",
    ),
    "explain": (
        "show the equations as built, the regime of the orbit and the arithmetic of each gate",
        "explain kirchhoff/screw --rung f80",
        """
scene SCENE
--rung R [f64]  default: f64
""",
    ),
    "tradeoff": (
        "measure the time and the error of every setting of every solver",
        "tradeoff euler/generic --rung f64 --target 1e-9",
        """
scenes* SCENE
--target E  also find the fastest setting whose error stays below E on the scene and on starts nearby;
  exit status 3 where there is none
--rung+ R  default: f32 f64 f80 f128
--solver* S  measure this setting of a solver and no others but taylor's, which are the yardstick; may
  be repeated: --solver "process:./mine" --solver "geometric:splitting?step=0.01"
--outside  measure the integrators of other libraries too, each in an environment of its own, which is
  made the first time (a download)
--cold  also start each setting in a new process with nothing compiled, and tell importing, compiling
  and solving apart
--repeats N [5]  timed solves of a setting; default: 5
--seed N [1]  of the order and the starts; default: 1
--out DIR  write the numbers and the work-precision pictures there
""",
    ),
    "sweep": (
        "solve and judge many bodies and starts, drawn from a family",
        "sweep satellites --count 1000 --seed 1 --out swept",
        """
what FAMILY  a shipped family (`list` names them), a template (a scene file in which numbers are drawn), or
  a folder of scenes
--count N  points that are drawn; default: what the template says, else 100
--seed N  default: what the template says, else 1; point k of a seed is always the same
--points random|sobol  how the points are spread; default: what the template says, else random
--solver S [taylor]  default: taylor
--rung R [f64]  default: f64
--executor E [local]  local, or dask:ADDRESS of a scheduler; default: local
--jobs N  processes on this machine; default: one a core
--out DIR  write the rows (Parquet), a summary, a picture and the worst cases there
--resume  go on with the sweep in --out, which was ended before its end
--worst N [10]  the worst cases that are written as scenes; default: 10
""",
    ),
    "draw": (
        "draw the exact motion of a scene, and the errors of trajectory files",
        "draw euler/tennis-racket --animate --out racket.html",
        """
scene SCENE
files* FILE  trajectories, read as `check` reads them: their errors in time are drawn too
--out NAME  write NAME-polhode.svg and so on; the ending of NAME says the format: .svg (default), .pdf, .png
--only NAME,...  draw these and no others: polhode, momentum, bifurcation, time, herpolhode, axis, spheres,
  path, errors; a single one has the name of --out itself
--animate  draw one moving picture: a page that turns, with no network (--out NAME.html, the default), or a
  film (.gif; .mp4 needs ffmpeg)
--rung R [f64]  precision of the arithmetic that made the files; default: f64
--columns* NAME=THEIRS,...  the file's column for a name of ours, as in `check`
--accept-conventions  correct the conventions of the files before their errors are drawn, as in `check`
""",
    ),
    "claims": (
        "check every numbered equation and every claim of the two source texts",
        'claims "hydromechanics 49 (17)"',
        """
ids* ID  "heinbockel (2.2.70)", its number "(2.2.70)", or a whole text: "hydromechanics 48"; default: all
""",
    ),
    # Its arguments are those of the studies.
    "publish": (
        "measure and write what is published, or make its pages of what is stored",
        "publish growth --periods 1e4",
        "",
    ),
}


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Return the options, with the function of the verb as ``act``.

    Raises SystemExit for --help and for a wrong call.
    """
    parser = _parser("publish" in arguments)
    try:
        options, left = parser.parse_known_args(_with_times_attached(arguments))
    except argparse.ArgumentError as error:
        parser.error(_unknown_verb(arguments) if error.argument_name == _VERB else str(error))
    if options.completion:
        options.act = partial(_complete, options.completion)
    scenes = getattr(options, "scenes", None)
    files = getattr(options, "files", None)
    studies = getattr(options, "studies", None)
    if studies is not None:
        # An option that is none is named by the verb, beside what there is: `--growth` was one.
        options.studies, left = [*studies, *left], []
    if left and ((scenes is None and files is None) or any(word.startswith("-") for word in left)):
        options.verb.error(_unknown_words(left, options.verb))
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
    return (
        f"expected a verb, got {word} ({_near(word, _VERBS, '`taylor-verify --help` names them')})"
    )


def _unknown_words(words: Sequence[str], verb: argparse.ArgumentParser) -> str:
    """Return the message for words that a verb does not take, with the options that may be meant."""
    known = re.findall(r"--[a-z-]+", verb.format_usage())
    options = [word for word in words if word.startswith("-")]
    named = [f"{word} ({_near(word, known, 'there is none like it')})" for word in options]
    expected = "the options" if named else "no words but those"
    return f"expected {expected} above, got {', '.join(named or words)}"


def _near(word: str, known: Iterable[str], otherwise: str) -> str:
    close = difflib.get_close_matches(word.partition("=")[0], [*known], n=3, cutoff=0.65)
    return f"did you mean {', '.join(close)}?" if close else otherwise


def _greet(options: argparse.Namespace) -> Answer:
    from taylor_verify.cli.greeting import greeting

    del options
    return greeting()


def _complete(shell: str, options: argparse.Namespace) -> Answer:
    from taylor_verify.cli.completion import completion

    del options
    return completion(_parser(is_publishing=True), shell)


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
    """Return the rungs and the scenes among the words behind each ``--rung``; its first word is a rung."""
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
        # `parse` reports a wrong verb, with the verbs that are near to it.
        exit_on_error=False,
    )
    parser.add_argument("--version", action="version", version=f"taylor-verify {__version__}")
    parser.add_argument(
        "--completion",
        metavar="SHELL",
        choices=SHELLS,
        help=f"print the script that makes a shell complete words: {', '.join(SHELLS)} (shtab)",
    )
    parser.set_defaults(act=_greet, verb=parser, json=False)
    verbs = parser.add_subparsers(title="verbs", metavar=_VERB)
    for name, (what, example, arguments) in _VERBS.items():
        verb = verbs.add_parser(
            name,
            help=what,
            description=what[0].upper() + what[1:] + ".",
            epilog=f"example: taylor-verify {example}",
            allow_abbrev=False,
        )
        verb.add_argument("--json", action="store_true", help="print one JSON document on stdout")
        verb.set_defaults(act=partial(_act, name), verb=verb)
        for line in arguments.replace("\n  ", " ").split("\n"):
            if line:
                _add(verb, line)
        if name == "publish":
            verb.set_defaults(act=publishing.publish)
            publishing.add_options(verb, is_publishing)
    return parser


def _act(name: str, options: argparse.Namespace) -> Answer:
    """Import the module of a verb and let it answer."""
    answer: Answer = import_module(f"taylor_verify.cli.{name}").answer(options)
    return answer


def _add(verb: argparse.ArgumentParser, line: str) -> None:
    """Add the argument that a line of the text describes."""
    match = _ARGUMENT.fullmatch(line)
    assert match is not None, line
    name, sign, value, default, meaning = match.groups()
    if value is None:
        verb.add_argument(name, action="store_true", help=meaning)
        return
    first, *others = value.split("|")
    given: dict[str, Any] = {"help": meaning, "metavar": None if others else first}
    if others:
        given["choices"] = [first, *others]
    if value == "N":
        given["type"] = int
    if sign == "!":
        given["required"] = True
    elif sign and name.startswith("-"):
        given |= {"action": "append", "nargs": "+" if sign == "+" else None}
    elif sign:
        given["nargs"] = sign
    verb.add_argument(name, default=default, **given)
