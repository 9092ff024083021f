"""What a person sees: tables on stdout, progress on stderr."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import groupby
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

if TYPE_CHECKING:
    from verify.judge.verdict import Verdict
    from verify.standard import Job

# Piped output keeps whole rows: a table cut to 80 columns cannot be read by the next program.
_PIPED_WIDTH = 140
_STATES = ("omega", "impulse", "attitude", "centre")
_COLOURS = {"pass": "green", "fail": "red", "undecided": "yellow", "vacuous": "yellow"}


def print_verdicts(verdicts: Sequence[Verdict]) -> None:
    """A line for each scene and rung, then whatever is not a pass with its reason, then the counts."""
    from verify.judge.verdict import summary

    console = _console()
    table = Table(
        "scene", "rung", "state error/u", "at t", "of attainable", "worst drift/u", "", "steps",
        "seconds", "verdict", title="errors in units of roundoff u = 2^-bits", box=None,
    )  # fmt: skip
    for column in (2, 3, 4, 5, 7, 8):
        table.columns[column].justify = "right"
    for (scene, rung), group in groupby(verdicts, key=lambda v: (v.scene, v.rung)):
        table.add_row(scene, rung, *_run_cells(list(group)))
    console.print(table)
    for verdict in verdicts:
        if verdict.verdict.value != "pass":
            console.print(
                f"{_status(verdict.verdict.value)}  {verdict.scene} {verdict.rung} "
                f"{verdict.quantity}: {_told(verdict)}"
            )
    counts = ", ".join(f"{count} {status}" for status, count in summary(verdicts).items() if count)
    console.print(f"\n{counts}")


def _run_cells(group: list[Verdict]) -> tuple[str, ...]:
    worst_status = next((v.verdict.value for v in group if v.verdict.value != "pass"), "pass")
    states = [v for v in group if v.quantity in _STATES]
    drifts = [v for v in group if v.quantity not in _STATES and v.max is not None]
    if not states or states[0].max is None:
        return ("-", "-", "-", "-", "", "-", "-", _status(worst_status))
    state = max(states, key=lambda v: v.ratio or 0.0)
    drift = max(drifts, key=_units, default=None)
    return (
        f"{_units(state):.3g}",
        f"{state.at:g}",
        f"{state.ratio:.2g}" if state.ratio is not None else "-",
        f"{_units(drift):.3g}" if drift else "-",
        drift.quantity if drift else "",
        str(state.steps),
        f"{state.seconds:.3f}" if state.seconds is not None else "-",
        _status(worst_status),
    )


def _units(verdict: Verdict) -> float:
    """The largest error in units of roundoff; a missing one counts as larger than any."""
    if verdict.max is None or not verdict.roundoff:
        return float("inf")
    return verdict.max / verdict.roundoff


def _told(verdict: Verdict) -> str:
    error = f"error {verdict.max:.2g} at t = {verdict.at:g}, " if verdict.max is not None else ""
    bound = f"bound {verdict.bound:.2g}; " if verdict.bound is not None else ""
    return f"{error}{bound}{verdict.because}"


def _status(status: str) -> str:
    colour = _COLOURS.get(status, "magenta")
    return f"[{colour}]{status}[/{colour}]"


def print_exact(found: dict[str, Any]) -> None:
    console = _console()
    console.print(f"{found['scene']}: {found['regime']} (route {found['route']})")
    for row in found["rows"]:
        console.print(f"t = {row['t']}   (relative radius {row['radius']})")
        for name, value in row.items():
            if name not in ("t", "radius"):
                _print_quantity(console, name, value)


def _print_quantity(console: Console, name: str, value: Sequence[Any]) -> None:
    lines = [" ".join(row) for row in value] if isinstance(value[0], list) else value
    for i, line in enumerate(lines):
        console.print(f"  {name if i == 0 else '':16s} {line}", soft_wrap=True)


def print_explanation(found: dict[str, Any]) -> None:
    console = _console()
    console.print(f"[bold]{found['scene']}[/bold]: {found['title']}", soft_wrap=True)
    for warning in found["warnings"]:
        console.print(f"[yellow]warning[/yellow] {warning}")
    console.print(f"\ntracked: {', '.join(found['track'])}\n\nequations as built:")
    for line in found["equations"] or ("(none: the run did not come to a comparison)",):
        console.print(f"  {line}", markup=False, soft_wrap=True)
    if found["parameters"] is not None:
        _print_data(console, found)
    console.print(f"\ngates on {found['rung']}:")
    for gate in found["gates"]:
        console.print(f"  {gate['quantity']:10s} {_status(gate['verdict'])}", highlight=False)
        console.print(f"    {_gate_line(gate)}", soft_wrap=True)
        console.print(f"    bound = {gate['because']}", soft_wrap=True)


def _print_data(console: Console, found: dict[str, Any]) -> None:
    cost, units = found["cost"], found["units"]
    named = ", ".join(f"{name} = {value}" for name, value in found["parameters"].items())
    console.print(f"  with {named}", markup=False, soft_wrap=True)
    unit_text = ", ".join(f"{name} {value}" for name, value in units.items())
    console.print(f"  in units (exact powers of two): {unit_text}")
    console.print(f"\nregime: {found['regime']}; truth: {found['route']}, {found['truth_digits']} digits")
    console.print(
        f"cost: {cost['states']} states, {cost['steps']} steps, {cost['evaluations']} Taylor orders, "
        f"{cost['seconds']:.3g} s"
    )


def _gate_line(gate: dict[str, Any]) -> str:
    if gate["error"] is None:
        return "no error: nothing was compared"
    return (
        f"error {gate['error']:.3g} at t = {gate['at']:g} ({gate['unit']}), "
        f"attainable {gate['attainable']:.3g}, bound {gate['bound']:.3g}"
    )


@contextmanager
def progress(total: int) -> Iterator[Callable[[Job], None]]:
    """A bar on stderr that advances as jobs end."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    console = Console(stderr=True)
    with Progress(*columns, TimeElapsedColumn(), console=console, transient=True) as bar:
        task = bar.add_task("compiling and solving", total=total)

        def finished(job: Job) -> None:
            bar.update(task, advance=1, description=job.scene)
            if not console.is_terminal:
                console.print(f"{job.scene} {' '.join(job.rungs)}: done", highlight=False)

        yield finished


@contextmanager
def spinner(what: str) -> Iterator[None]:
    """A sign of life on stderr while one long thing is computed."""
    with Console(stderr=True).status(what):
        yield


def _console() -> Console:
    console = Console()
    return console if console.is_terminal else Console(width=_PIPED_WIDTH)

