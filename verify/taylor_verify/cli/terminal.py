"""The texts that a person reads: names, verdicts, the exact motion, an explanation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.text import Text

from taylor_verify.cli.console import PIPED_WIDTH, new_console, print_indented, print_line, text_of
from taylor_verify.cli.sentences import print_arithmetic, print_end, print_sentence, status_text
from taylor_verify.cli.table import Cell, Heading, print_table
from taylor_verify.records.json_text import converted
from taylor_verify.records.quantities import STATES
from taylor_verify.records.reason import Reason
from taylor_verify.records.status import gravest

if TYPE_CHECKING:
    from taylor_verify.batch.expectations import Agreement
    from taylor_verify.records.answers import LikelyCause
    from taylor_verify.records.verdict import Verdict

# The sentences of so many runs come before the lines of the overview.
_FEW = 2
_OVERVIEW = (
    *(Heading("scene"), Heading("rung"), Heading("verdict")),
    *(Heading("state"), Heading("error/u", to_right=True), Heading("at t", to_right=True)),
    *(Heading("drift"), Heading("error/u", to_right=True)),
    *(Heading(name, to_right=True) for name in ("/floor", "steps", "seconds")),
)

# The unit of time is the scene's, whatever that is.
_UNITS = {
    "time": "time units",
    "1/time": "per time unit",
    "radians/time": "radians per time unit",
}


def names_text(
    found: Mapping[str, Sequence[str]], titles: Mapping[str, str], guide: Mapping[str, str]
) -> str:
    """Return everything that has a name, and first which scene tells what."""
    console = new_console()
    print_line(console, Text("which scene tells what", "bold"))
    guide_width = max(map(len, guide), default=0)
    for name, purpose in guide.items():
        print_line(console, f"  {name:{guide_width}}  {purpose}")
    width = max(map(len, titles), default=0)
    for heading, entries in found.items():
        print_line(console, Text(heading, "bold"))
        for entry in entries:
            title = titles.get(entry, "")
            print_line(console, f"  {entry:{width}}  {title}".rstrip())
    return text_of(console)


# run


def verdicts_text(
    verdicts: Sequence[Verdict],
    held: Agreement,
    status: int | None,
    causes: Sequence[LikelyCause] = (),
    explained: bool = False,
) -> str:
    """Return the sentences of a run or two and then a line for each; of many runs the lines come first.

    Of many runs only rows that are no pass have a sentence. Where no row was judged, and all for one
    reason, the counts and the reason are enough. With ``explained`` the arithmetic of the bounds is there.
    """
    from taylor_verify.records.showing import counts

    # A path of any length keeps its row in one line of a pipe; on a terminal it is folded.
    console = new_console(PIPED_WIDTH + max((len(v.scene) for v in verdicts), default=0))
    why = held.unjudged(verdicts)
    if not why or len({verdict.because for verdict in verdicts}) > 1:
        _print_rows(console, verdicts, held, causes, explained)
    total = f"{counts(verdicts)}{_as_expected(verdicts, held)}"
    unexpected = [verdict for verdict in verdicts if held.met(verdict) is None]
    print_end(console, unexpected, total, status, explained)
    if why:
        print_line(console, f"nothing was judged: {why}")
    return text_of(console)


def _print_rows(
    console: Console,
    verdicts: Sequence[Verdict],
    held: Agreement,
    causes: Sequence[LikelyCause],
    explained: bool,
) -> None:
    runs = [(run, list(rows)) for run, rows in groupby(verdicts, key=lambda v: (v.scene, v.rung))]
    is_few = len(runs) <= _FEW
    if is_few:
        for (scene, rung), rows in runs:
            print_line(console, Text(scene, "bold"), f" in {rung} arithmetic")
            for verdict in rows:
                print_sentence(console, verdict, why=_expected(verdict, held))
            for cause in causes:
                if (cause.scene, cause.rung) == (scene, rung):
                    print_line(console, Text("likely cause", "bold yellow"), f": {cause.sentence}")
            print_line(console)
    _print_overview(console, runs)
    print_line(console)
    if any(verdict.tolerance is not None for verdict in verdicts):
        print_line(console, "Judged by the tolerance that was asked for.")
    others = [verdict for verdict in verdicts if verdict.verdict.value != "pass"]
    for verdict in () if is_few else others:
        place = f"{verdict.scene} {verdict.rung}"
        print_sentence(console, verdict, place, _expected(verdict, held))
    for cause in () if is_few else causes:
        told = f"  {cause.scene} {cause.rung}: {cause.sentence}"
        print_line(console, Text("likely cause", "bold yellow"), told)
    for mismatch in held.mismatches:
        print_line(console, Text("not as expected", "bold red"), f"  {mismatch}")
    if explained:
        for (scene, rung), rows in runs:
            print_line(console, Text(scene, "bold"), f" in {rung} arithmetic")
            print_arithmetic(console, rows)
    if explained or held.mismatches or (others and not is_few):
        print_line(console)


def _expected(verdict: Verdict, held: Agreement) -> str:
    expected = held.met(verdict)
    return "" if expected is None else expected.why


def _as_expected(verdicts: Sequence[Verdict], held: Agreement) -> str:
    """How many of the rows that are no pass are what the extremes are expected to answer."""
    met = sum(held.met(verdict) is not None for verdict in verdicts)
    wrong = len(held.mismatches)
    return (f"; {met} of them as expected" if met else "") + (
        f"; {wrong} not as expected" if wrong else ""
    )


def _print_overview(
    console: Console, runs: Sequence[tuple[tuple[str, str], list[Verdict]]]
) -> None:
    """Print a line for each run: its worst state, its worst drift, what it cost."""
    rows = [[scene, rung, *_run_cells(group)] for (scene, rung), group in runs]
    print_table(console, _OVERVIEW, rows, keys=2)
    print_line(console)
    print_indented(
        console,
        "",
        "Errors and drifts are the largest of all samples, in units of roundoff u = 2^-bits; "
        "/floor is the largest error over what perfect rounding would leave, of all gates.",
    )


def _run_cells(group: list[Verdict]) -> tuple[Cell, ...]:
    status = status_text(gravest(v.verdict for v in group))
    compared = [v for v in group if v.at is not None]
    if not compared:
        return (status, *[""] * 8)
    state = max((v for v in compared if v.quantity in STATES), key=_ratio)
    drift = max((v for v in compared if v.is_conserved), key=_units, default=None)
    return (
        status,
        state.quantity,
        f"{_units(state):.3g}",
        f"{state.at:.6g}",
        drift.quantity if drift else "",
        f"{_units(drift):.3g}" if drift else "",
        f"{max(map(_ratio, compared)):.2g}",
        str(state.steps or ""),
        f"{state.seconds:.3f}" if state.seconds is not None else "",
    )


def _units(verdict: Verdict) -> float:
    """The largest error in units of roundoff; one that is no number counts as larger than any."""
    if verdict.max is None or not verdict.roundoff or verdict.max != verdict.max:
        return float("inf")
    return verdict.max / verdict.roundoff


def _ratio(verdict: Verdict) -> float:
    """The largest error over attainable; one that is no number counts as larger than any."""
    ratio = verdict.ratio
    return ratio if ratio is not None and ratio == ratio else float("inf")


def error_sentences(gate: Mapping[str, Any]) -> tuple[str, str]:
    """Return the error and its ratio of a gate, from a row or an explanation; null is not finite."""
    size, bound = figure(gate["max"]), figure(gate["bound"])
    ratio = "not finite" if gate["ratio"] is None else f"{gate['ratio']:.2g}"
    return (
        f"largest error {size} ({gate['unit']}) at t = {gate['at']:g}, where {bound} is allowed",
        f"largest error/attainable {ratio} at t = {gate['ratio_at']:g}",
    )


def figure(value: float | None) -> str:
    return "not finite" if value is None or value != value else f"{value:.3g}"


# exact


def exact_text(found: Mapping[str, Any]) -> str:
    console = new_console()
    print_line(
        console,
        Text(found["scene"], "bold"),
        f": {found['regime']} (route {found['route']}, {found['evidence']})",
    )
    for row in found["rows"]:
        print_line(console, f"\nt = {row['t']}   (relative radius {row['radius']})")
        for name, value in row.items():
            if name not in ("t", "radius", "absolute"):
                _print_quantity(console, name, value)
        for name, size in row.get("absolute", {}).items():
            print_line(console, f"  {name} cannot be told from zero: its size is at most {size}")
    return text_of(console)


def _print_quantity(console: Console, name: str, value: Sequence[Any]) -> None:
    rows = [row if isinstance(row, list) else [row] for row in value]
    # A column for the sign, so that digits stand below digits.
    signed = [[text if text.startswith("-") else f" {text}" for text in row] for row in rows]
    width = max(len(text) for row in signed for text in row)
    for i, row in enumerate(signed):
        entries = " ".join(text.ljust(width) for text in row).rstrip()
        print_line(console, f"  {name if i == 0 else '':15} {entries}")


# explain


def explanation_text(found: Mapping[str, Any]) -> str:
    console = new_console()
    print_line(console, Text(found["scene"], "bold"), f": {found['title']}")
    if found["source"]:
        print_line(console, f"source: {found['source']}")
    for warning in found["warnings"]:
        print_line(console, Text("warning", "yellow"), f": {warning}")
    for sentence in found["body"]:
        print_indented(console, "body: ", sentence)
    print_line(console, f"tracked: {', '.join(found['track'])}")
    if found["equations"] is not None:
        _print_problem(console, found)
    print_line(console)
    print_line(console, Text(f"gates on {found['rung']}", "bold"), f", u = 2^-{found['bits']}")
    for gate in found["gates"]:
        _print_gate(console, gate)
    return text_of(console)


def _print_problem(console: Console, found: Mapping[str, Any]) -> None:
    cost, units = found["cost"], found["units"]
    print_line(console)
    print_line(console, Text("equations as built", "bold"))
    for line in found["equations"]:
        print_line(console, f"  {line}")
    if found["parameters"]:
        print_line(console, "with, shown as doubles,")
        for name, value in found["parameters"].items():
            print_line(console, f"  {name:4} {float.fromhex(value)!r}")
    print_line(console, "in units (exact powers of two)")
    print_line(console, "  " + ", ".join(f"{name} {value}" for name, value in units.items()))
    print_line(console)
    _print_orbit(console, found)
    truth = f"  route {found['route']}, {found['truth_digits']} digits"
    print_line(console, Text("truth", "bold"), truth)
    for i, sentence in enumerate(cost["because"]):
        print_indented(console, "chosen   " if i == 0 else "         ", sentence)
    print_line(
        console,
        Text("cost", "bold"),
        f"   {_counted(cost)}\n"
        f"       general equations of this body: {_counted(cost['same'])}\n"
        f"       with all that the model has: {_counted(cost['general'])}",
    )
    if cost["steps"] is not None:
        order = cost["evaluations"] // cost["steps"] if cost["steps"] else 0
        print_line(
            console,
            f"       {cost['steps']} steps of order {order}: {cost['evaluations']} evaluations, "
            f"{cost['seconds']:.3g} s",
        )


def _counted(cost: Mapping[str, Any]) -> str:
    """What one evaluation of the equations takes."""
    return (
        f"{cost['states']} states; an evaluation takes {cost['products']} products, "
        f"{cost['sums']} sums and {cost['quotients']} quotients"
    )


def _print_orbit(console: Console, found: Mapping[str, Any]) -> None:
    """What the orbit is in words, its numbers, and how it carries an error on."""
    print_line(console, Text("orbit", "bold"), f"  {found['regime']}")
    for sentence in found["sentences"]:
        print_indented(console, "  ", sentence)
    numbers = found["elements"]
    if numbers:
        print_line(console, "numbers in the scene's own units")
    values = [
        f"{number['value']} {_UNITS.get(number['unit'], number['unit'])}".rstrip()
        for number in numbers
    ]
    name_width = max((len(number["name"]) for number in numbers), default=0)
    value_width = max(map(len, values), default=0)
    for number, value in zip(numbers, values, strict=True):
        label = f"  {number['name']:{name_width}}  {value:{value_width}}  "
        print_indented(console, label, number["meaning"])
    if found["condition"] is not None:
        print_line(console, Text("conditioning", "bold"))
        for sentence in found["condition"]["sentences"]:
            print_indented(console, "  ", sentence)


def _print_gate(console: Console, gate: Mapping[str, Any]) -> None:
    print_line(console)
    print_line(console, f"  {gate['quantity']:9} ", status_text(gate["verdict"]))
    if gate["at"] is not None:
        for part in error_sentences(gate):
            print_indented(console, "    ", part)
    because = converted(gate["reason"], Reason).parts()
    for i, part in enumerate(because):
        print_indented(console, "    because " if i == 0 else "            ", part)
