"""The texts that a person reads about scenes: their names, the exact motion, an explanation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.text import Text

from taylor_verify.cli.console import new_console, print_indented, print_line, text_of
from taylor_verify.cli.sentences import figure, status_text
from taylor_verify.records.json_text import converted
from taylor_verify.records.reason import Reason

if TYPE_CHECKING:
    pass

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
        size, bound = figure(gate["max"]), figure(gate["bound"])
        ratio = "not finite" if gate["ratio"] is None else f"{gate['ratio']:.2g}"
        for part in (
            f"largest error {size} ({gate['unit']}) at t = {gate['at']:g}, where {bound} is allowed",
            f"largest error/attainable {ratio} at t = {gate['ratio_at']:g}",
        ):
            print_indented(console, "    ", part)
    because = converted(gate["reason"], Reason).parts()
    for i, part in enumerate(because):
        print_indented(console, "    because " if i == 0 else "            ", part)
