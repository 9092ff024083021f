"""The verb `explain`: the equations, the orbit and the arithmetic of one run."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from functools import partial
from typing import Any

from rich.text import Text

from taylor_verify.cli.answer import PASS, Answer, CallParts
from taylor_verify.cli.console import Page, bold
from taylor_verify.cli.inputs import known_rungs, read_scene
from taylor_verify.cli.progress import working
from taylor_verify.cli.sentences import figure, status_text
from taylor_verify.explain.explanation import explanation
from taylor_verify.records.json_text import converted
from taylor_verify.records.reason import Reason
from taylor_verify.scenes.scene import Scene

# The unit of time is the scene's, whatever that is.
_UNITS = {
    "time": "time units",
    "1/time": "per time unit",
    "length/time": "length per time unit",
    "radians/time": "radians per time unit",
}


def answer(options: argparse.Namespace) -> Answer:
    """Explain one run."""
    parts = CallParts()
    rungs, scene = parts.read(known_rungs, [options.rung]), parts.read(_read, options.scene)
    parts.end()
    (rung,) = rungs
    with working(f"explain {options.scene}"):
        content = explanation(scene, rung)
    return Answer(PASS, content, partial(_text, content))


def _read(name: str) -> Scene:
    # The explanation itself has the warnings.
    return read_scene(name, warn=False)


def _text(content: Mapping[str, Any]) -> str:
    page = Page()
    page.line(bold(content["scene"]), f": {content['title']}")
    if content["source"]:
        page.line(f"source: {content['source']}")
    for warning in content["warnings"]:
        page.line(Text("warning", "yellow"), f": {warning}")
    for sentence in content["body"]:
        page.indented("body: ", sentence)
    page.line(f"tracked: {', '.join(content['track'])}")
    if content["equations"] is not None:
        _print_problem(page, content)
    page.line()
    page.line(bold(f"gates on {content['rung']}"), f", u = 2^-{content['bits']}")
    for gate in content["gates"]:
        _print_gate(page, gate)
    return page.text()


def _print_problem(page: Page, content: Mapping[str, Any]) -> None:
    cost, units = content["cost"], content["units"]
    page.line()
    page.line(bold("equations as built"))
    for line in content["equations"]:
        page.line(f"  {line}")
    if content["parameters"]:
        rounded = " and ".join(content["rounded"])
        words = f", the {rounded} rounded to {content['rung']}" if rounded else ""
        page.line(f"with, shown as doubles{words},")
        for name, value in content["parameters"].items():
            page.line(f"  {name:4} {float.fromhex(value)!r}")
    page.line("in units (exact powers of two)")
    page.line("  " + ", ".join(f"{name} {value}" for name, value in units.items()))
    page.line()
    _print_orbit(page, content)
    if content["loads"] is not None:
        _print_loads(page, content["loads"])
    page.line(bold("truth"), f"  route {content['route']}, {content['truth_digits']} digits")
    page.indented("chosen   ", *cost["because"])
    page.line(bold("cost"), f"   {_counted(cost)}")
    page.line(f"       general equations of this body: {_counted(cost['same'])}")
    page.line(f"       with all that the model has: {_counted(cost['general'])}")
    if cost["steps"] is not None:
        order = cost["evaluations"] // cost["steps"] if cost["steps"] else 0
        page.line(
            f"       {cost['steps']} steps of order {order}: {cost['evaluations']} evaluations, "
            f"{cost['seconds']:.3g} s",
        )


def _counted(cost: Mapping[str, Any]) -> str:
    """Return the cost of one evaluation of the equations."""
    return (
        f"{cost['states']} states; an evaluation takes {cost['products']} products, "
        f"{cost['sums']} sums and {cost['quotients']} quotients"
    )


def _print_orbit(page: Page, content: Mapping[str, Any]) -> None:
    """Print the regime of the orbit, its numbers, and how it carries an error on."""
    page.line(bold("orbit"), f"  {content['regime']}")
    if content["rung_regime"] != content["regime"]:
        rounded = f"numbers rounded to {content['rung']}"
        page.indented("  ", f"Judged is the motion of the {rounded}: {content['rung_regime']}.")
    page.indented("  ", *content["sentences"])
    numbers = [
        (n["name"], f"{n['value']} {_UNITS.get(n['unit'], n['unit'])}".rstrip(), n["meaning"])
        for n in content["elements"]
    ]
    if numbers:
        page.line("numbers in the scene's own units")
    names, values = (max((len(n[k]) for n in numbers), default=0) for k in (0, 1))
    for name, value, meaning in numbers:
        page.indented(f"  {name:{names}}  {value:{values}}  ", meaning)
    if content["condition"] is not None:
        page.line(bold("conditioning"))
        page.indented("  ", *content["condition"]["sentences"])


def _print_loads(page: Page, loads: Mapping[str, Any]) -> None:
    """Print what the loads conserve, and the size, the work and the price of each term."""
    page.line(bold("loads"), f"  {loads['switches']} switches" if loads["switches"] else "")
    page.indented("  ", *loads["conserved"])
    for vector, sizes in loads["free"].items():
        page.line(f"  {vector}, all terms but the loads: {_sized(sizes)}")
    for term in loads["terms"]:
        page.line(f"  {term['place']:9}  {term['text']}")
        for vector in loads["free"]:
            if term[vector]["largest"]:
                page.line(f"             {vector}: {_sized(term[vector])}")
        page.line(
            f"             work until the end {term['work']:.3g}; {_operations(term)}, "
            f"{1e9 * term['seconds']:.2g} ns a row"
        )
    page.line(f"  work of all loads {loads['work']:.3g}; {_operations(loads)}")


def _sized(sizes: Mapping[str, float]) -> str:
    return f"{sizes['largest']:.3g} at most (t = {sizes['at']:g}), {sizes['mean']:.3g} in the mean"


def _operations(term: Mapping[str, Any]) -> str:
    counted = {name: count for name, count in term["operations"].items() if count}
    return ", ".join(f"{count} {name}" for name, count in counted.items()) or "no operations"


def _print_gate(page: Page, gate: Mapping[str, Any]) -> None:
    page.line()
    page.line(f"  {gate['quantity']:9} ", status_text(gate["verdict"]))
    if gate["at"] is not None:
        size, bound = figure(gate["max"]), figure(gate["bound"])
        ratio = "not finite" if gate["ratio"] is None else f"{gate['ratio']:.2g}"
        page.indented(
            "    ",
            f"largest error {size} ({gate['unit']}) at t = {gate['at']:g}, where {bound} is allowed",
            f"largest error/attainable {ratio} at t = {gate['ratio_at']:g}",
        )
    page.indented("    because ", *converted(gate["reason"], Reason).parts())
