"""The command line: arguments and printing, nothing else.

Exit status: 0 pass; 1 a gate failed; 2 the input or the call was wrong; 3 undecided (nothing failed).
Nothing heavy is imported before a verb needs it, so that `--help` answers at once.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from verify.judge.judgement import Judgement

EXIT_PASS, EXIT_FAIL, EXIT_WRONG_CALL, EXIT_UNDECIDED, EXIT_INTERRUPTED = 0, 1, 2, 3, 130

_DEFAULT_DIGITS = 30


class WrongCall(Exception):
    """The call or its input was wrong; the text is the message."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one verb and return the exit status."""
    options = _parser().parse_args(arguments)
    try:
        return int(options.verb(options))
    except WrongCall as error:
        return _wrong(str(error))
    except KeyboardInterrupt:
        print("taylor-verify: interrupted; nothing was written", file=sys.stderr)
        return EXIT_INTERRUPTED
    except BrokenPipeError:
        # The reader of our output went away (`| head`); there is nobody left to tell.
        sys.stderr.close()
        return EXIT_PASS
    except Exception as error:
        if _is_about_the_input(error):
            return _wrong(str(error))
        raise


def _wrong(message: str) -> int:
    print(f"taylor-verify: {message}", file=sys.stderr)
    return EXIT_WRONG_CALL


def _is_about_the_input(error: Exception) -> bool:
    """A refused scene, or a file that cannot be read or written: no traceback helps with those."""
    from verify.scenes.faults import Refused

    return isinstance(error, Refused | OSError)


# Arguments.


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="taylor-verify",
        description="The reference that rigid-body and ideal-fluid simulations are measured against.",
        epilog="SCENE is a file or the name of a shipped scene, such as euler/generic. "
        "Exit status: 0 pass, 1 a gate failed, 2 wrong input or call, 3 undecided.",
    )
    verbs = parser.add_subparsers(title="verbs", metavar="VERB", required=True)
    _add_list(verbs)
    _add_run(verbs)
    _add_exact(verbs)
    _add_explain(verbs)
    _add_publish(verbs)
    return parser


def _verb(
    verbs: Any, name: str, what: str, example: str, act: Callable[[argparse.Namespace], int]
) -> argparse.ArgumentParser:
    verb: argparse.ArgumentParser = verbs.add_parser(
        name,
        help=what,
        description=what[0].upper() + what[1:] + ".",
        epilog=f"example: taylor-verify {example}",
    )
    verb.add_argument("--json", action="store_true", help="print one JSON document on stdout")
    verb.set_defaults(verb=act)
    return verb


def _add_list(verbs: Any) -> None:
    _verb(verbs, "list", "list the shipped scenes, solvers and rungs", "list --json", _list)


def _add_run(verbs: Any) -> None:
    what = "solve scenes, compare with the exact motion, judge"
    verb = _verb(verbs, "run", what, "run euler/generic --rung f32 f64", _run)
    verb.add_argument("scenes", nargs="*", metavar="SCENE", help="default: the standard set")
    verb.add_argument("--solver", default="taylor", help="default: taylor")
    verb.add_argument(
        "--rung",
        nargs="+",
        action="extend",
        metavar="R",
        help="f32 f64 f80 f128 mpN; default: f64 for named scenes, all five for the standard set",
    )
    verb.add_argument("--out", metavar="DIR", help="write verdicts, records and tables there")


def _add_exact(verbs: Any) -> None:
    what = "print the exact motion of a scene at the times given"
    verb = _verb(verbs, "exact", what, "exact euler/generic --at 0,10,1e9 --digits 40", _exact)
    verb.add_argument("scene", metavar="SCENE")
    verb.add_argument("--at", required=True, metavar="T,T,...", help="decimals or a/b, absolute")
    verb.add_argument("--digits", type=int, default=_DEFAULT_DIGITS, help="default: 30")
    verb.add_argument("--route", choices=("mpmath", "arb", "taylor"), help="default: the best there is")


def _add_explain(verbs: Any) -> None:
    what = "show the equations as built, the regime of the orbit and the arithmetic of each gate"
    verb = _verb(verbs, "explain", what, "explain kirchhoff/screw --rung f80", _explain)
    verb.add_argument("scene", metavar="SCENE")
    verb.add_argument("--rung", default="f64", metavar="R", help="default: f64")


def _add_publish(verbs: Any) -> None:
    what = "rebuild the tables from verdicts and records"
    verb = _verb(verbs, "publish", what, "publish --from reports/local", _publish)
    verb.add_argument("--from", dest="folder", default="reports", metavar="DIR", help="default: reports")


# Verbs.


def _list(options: argparse.Namespace) -> int:
    from verify.scenes.library import names
    from verify.scenes.precision import LADDER
    from verify.solvers.registry import NAMES

    found = {"scenes": list(names()), "solvers": list(NAMES), "rungs": list(LADDER)}
    if options.json:
        return _print_json(found, EXIT_PASS)
    for heading, entries in found.items():
        print(f"{heading}:")
        for entry in entries:
            print(f"  {entry}")
    return EXIT_PASS


def _run(options: argparse.Namespace) -> int:
    from verify.scenes.library import names
    from verify.scenes.precision import LADDER

    rungs = _known_rungs(options.rung or (["f64"] if options.scenes else LADDER))
    _known_solver(options.solver)
    scenes = options.scenes or list(names())
    _readable(scenes)
    writable = _writable(options.out) if options.out else None
    results = _judge(scenes, options.solver, rungs)
    from verify.judge.verdict import exit_status, summary

    verdicts = [verdict for result in results for verdict in result.verdicts]
    status = exit_status(verdicts)
    if writable:
        _write_reports(writable, results)
    if options.json:
        rows = [verdict.row() for verdict in verdicts]
        return _print_json({"verdicts": rows, "summary": summary(verdicts)}, status)
    from verify.cli.terminal import print_verdicts

    print_verdicts(verdicts)
    return status


def _exact(options: argparse.Namespace) -> int:
    from verify.exact.printed import document
    from verify.exact.route import solution
    from verify.exact.solution import NoClosedForm, Unsettled
    from verify.scenes.reader import load

    if options.route == "arb":
        raise WrongCall(
            "expected --route mpmath or taylor, got arb: the route by Arb balls is not built in this "
            "version"
        )
    if not 1 <= options.digits <= 10_000:
        raise WrongCall(f"expected --digits from 1 to 10000, got {options.digits}")
    times = [(text, _time(text)) for text in options.at.split(",")]
    scene = load(options.scene)
    try:
        found = solution(scene, options.route or "mpmath")
    except NoClosedForm as reason:
        return _no_closed_form(options, scene.name, str(reason))
    try:
        with _working(f"exact {scene.name}"):
            printed = document(scene, found, times, options.digits)
    except Unsettled as doubt:
        print(f"taylor-verify: undecided: {doubt}", file=sys.stderr)
        return EXIT_UNDECIDED
    if options.json:
        return _print_json(printed, EXIT_PASS)
    from verify.cli.terminal import print_exact

    print_exact(printed)
    return EXIT_PASS


def _explain(options: argparse.Namespace) -> int:
    from verify.explain import explanation

    (rung,) = _known_rungs([options.rung])
    with _working(f"explain {options.scene}"):
        found = explanation(options.scene, rung)
    if options.json:
        return _print_json(found, EXIT_PASS)
    from verify.cli.terminal import print_explanation

    print_explanation(found)
    return EXIT_PASS


def _publish(options: argparse.Namespace) -> int:
    from verify.publish.report import publish

    written = [str(path) for path in publish(options.folder)]
    if options.json:
        return _print_json({"written": written}, EXIT_PASS)
    for path in written:
        print(path)
    return EXIT_PASS


# What the verbs share.


def _judge(scenes: Sequence[str], solver: str, rungs: Sequence[str]) -> list[Judgement]:
    from verify.standard import jobs, run_all
    from verify.cli.terminal import progress

    asked = jobs(scenes, solver, rungs)
    with progress(len(asked)) as finished:
        return run_all(asked, finished)


def _working(what: str) -> Any:
    from verify.cli.terminal import spinner

    return spinner(what)


def _no_closed_form(options: argparse.Namespace, scene: str, reason: str) -> int:
    from verify.exact.solution import NO_CLOSED_FORM

    message = f"{scene}: {reason}; use --route taylor"
    if options.json:
        found = {
            "scene": scene,
            "route": options.route or "mpmath",
            "digits": options.digits,
            "regime": NO_CLOSED_FORM,
            "rows": [],
            "because": message,
        }
        return _print_json(found, EXIT_UNDECIDED)
    print(f"taylor-verify: no closed form: {message}", file=sys.stderr)
    return EXIT_UNDECIDED


def _known_rungs(rungs: Sequence[str]) -> list[str]:
    from verify.scenes.precision import rung

    try:
        return [rung(name).name for name in dict.fromkeys(rungs)]
    except ValueError as error:
        raise WrongCall(str(error)) from error


def _known_solver(name: str) -> None:
    from verify.solvers.registry import NAMES, unknown_solver

    if name not in NAMES:
        raise WrongCall(unknown_solver(name))


def _readable(scenes: Sequence[str]) -> None:
    """Read every scene before the first is run, and report the faults of all of them."""
    from verify.scenes.faults import Refused
    from verify.scenes.reader import load

    faults = []
    for scene in scenes:
        try:
            for warning in load(scene).warnings:
                print(f"taylor-verify: warning: {scene}: {warning}", file=sys.stderr)
        except Refused as error:
            faults.append(f"{scene}:\n{error}")
    if faults:
        raise WrongCall("\n".join(faults))


def _time(text: str) -> Fraction:
    from verify.scenes.faults import Refused
    from verify.scenes.table import exact_number

    try:
        return exact_number(text.strip())
    except (ValueError, Refused) as error:
        raise WrongCall(f"expected times as decimals or a/b, got {text!r} @ --at") from error


def _writable(folder: str) -> Any:
    """The folder, made and tried out before hours of work end in a refusal to write."""
    import tempfile
    from pathlib import Path

    path = Path(folder)
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            return path
    except OSError as error:
        raise WrongCall(
            f"expected a folder that can be written, got {folder} ({error.strerror}) @ --out"
        ) from error


def _write_reports(folder: Any, results: Sequence[Judgement]) -> None:
    from verify.publish.report import publish, write

    verdicts = [verdict for result in results for verdict in result.verdicts]
    records = [result.record for result in results if result.record is not None]
    write(folder, verdicts, records)
    publish(folder)


def _print_json(found: dict[str, Any], status: int) -> int:
    print(json.dumps(found, indent=1, allow_nan=False))
    return status
