"""An FMU as a program that speaks the protocol: `python runner.py FMU FOLDER SETTINGS`.

The FMU, for co-simulation, is unpacked into FOLDER. SETTINGS is JSON: `step`, the longest communication
step or null for that of the FMU; `names`, lists of variables of the FMU in place of those in the table;
`fixed`, what is built into the FMU and not set. Three names for a matrix are its diagonal; the name of an
array of the FMU stands for its entries. An index counts from 1, that of a quaternion from 0.
`docs/formats.md` has the table of names: what is set before the run, and what is read at each time.

fmpy's own `simulate_fmu` samples at one interval alone, and a scene has its samples anywhere.

Of what says the same, inertia and inverse_inertia, omega_start and angular_momentum_start, one is enough.
What is zero, or no rotation, may be missing.
"""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from time import perf_counter
from typing import Any

_LETTERS = {
    **{"inertia": "I", "inverse_inertia": "K", "moment": "M"},
    **{"linear": "A", "coupling": "B", "angular": "C", "force": "X", "couple": "L"},
    **{"omega": "w", "angular_momentum": "H", "linear_impulse": "x", "angular_impulse": "y"},
    **{"attitude": "q", "centre": "c"},
}
_SAME = (("inertia", "inverse_inertia"), ("omega_start", "angular_momentum_start"))
_START = "_start"
# Steps that differ by no more are equal, but for the rounding of the times.
_EQUAL = 1e-9

Names = Mapping[str, Sequence[str]]


class Fault(Exception):
    """A fault of the FMU or of its settings, as a sentence."""


def floats(number: Any) -> Any:
    """Return the doubles of a number, vector or matrix: each is there as `text` and as `hex`."""
    if isinstance(number, dict):
        return floats(number["hex"])
    return (
        [floats(entry) for entry in number] if isinstance(number, list) else float.fromhex(number)
    )


def flat(value: Any, first: int, index: str = "") -> Iterator[tuple[str, float]]:
    """Yield the entries of a number, vector or matrix with their indices: `12` is row 1, column 2."""
    if not isinstance(value, list):
        yield index, value
        return
    for i, entry in enumerate(value, start=first):
        yield from flat(entry, first, f"{index}{i}")


def values_to_set(question: Any) -> dict[str, dict[str, float]]:
    """Return the numbers of the question by quantity and by default name."""
    values = {}
    for suffix, table in (("", question["body"]), (_START, question["initial"])):
        for key, number in table.items():
            value, first = floats(number), 1
            if key == "attitude":
                length, first = math.sqrt(sum(entry * entry for entry in value)), 0
                value = [entry / length for entry in value]
            letter = _LETTERS.get(key, key)
            values[key + suffix] = {f"{letter}{i}{suffix}": v for i, v in flat(value, first)}
    return values


def neutral(quantity: str, values: Mapping[str, float]) -> bool:
    """Return True for zeros, and for the quaternion of no rotation."""
    numbers = list(values.values())
    return not any(numbers[1:] if quantity == f"attitude{_START}" else numbers)


class Variables:
    """The variables of an FMU by name, each of one real number."""

    def __init__(self, description: Any, names: Names) -> None:
        self.references = {
            variable.name: variable.valueReference
            for variable in description.modelVariables
            if variable.type in ("Real", "Float64") and not getattr(variable, "dimensions", None)
        }
        self.names = names

    def of(self, quantity: str, default: Sequence[str]) -> list[str]:
        """Return the variables of a quantity, in the order of the default names; "" for what has none."""
        if quantity not in self.names:
            return list(default)
        names = list(self.names[quantity])
        if len(names) == 1 and names[0] not in self.references:
            names = self._entries(names[0], len(default))
        if len(default) == 9 and len(names) == 3:
            a, b, c = names
            names = [a, *[""] * 3, b, *[""] * 3, c]
        if missing := [name for name in names if name and name not in self.references]:
            raise Fault(f"expected a variable of the FMU, got {missing[0]} @ {quantity}")
        if len(names) != len(default):
            raise Fault(f"expected {len(default)} names, got {len(names)} @ {quantity}")
        return names

    def _entries(self, name: str, count: int) -> list[str]:
        """Return the entries of a matrix or of a vector of the FMU; a vector may be the diagonal."""
        if count == 9 and f"{name}[1,1]" in self.references:
            return [f"{name}[{i},{k}]" for i in (1, 2, 3) for k in (1, 2, 3)]
        return [f"{name}[{i}]" for i in range(1, (3 if count == 9 else count) + 1)]

    def settings(self, question: Any, fixed: Sequence[str]) -> Iterator[tuple[int, float]]:
        """Yield references and values of all that is set; raise Fault for what the FMU cannot be told."""
        wanted = values_to_set(question)
        covered = {key for key in wanted if key in fixed or neutral(key, wanted[key])}
        for key, values in wanted.items():
            unknown, known = False, []
            for name, value in zip(self.of(key, list(values)), values.values(), strict=True):
                if name in self.references:
                    known.append((self.references[name], value))
                else:
                    unknown = unknown or value != 0
            if known and key not in fixed:
                yield from known
                covered |= set() if unknown else {key}
        for first, other in _SAME:
            covered |= {first, other} if covered & {first, other} else set()
        others = {other for first, other in _SAME if first in wanted}
        if missing := [key for key in wanted if key not in covered | others]:
            names = {key: list(wanted[key]) for key in missing}
            listed = ", ".join(f"{key} ({n[0]} ... {n[-1]})" for key, n in names.items())
            raise Fault(
                f"expected variables for {listed}, got none or not all @ FMU (name its own: "
                f"?{missing[0]}=NAME,NAME,...; what is built into it: ?fixed={missing[0]})"
            )

    def outputs(self, columns: Sequence[str]) -> list[int]:
        """Return the references of the columns of the answer."""
        names: dict[str, str] = {}
        for key, letter in _LETTERS.items():
            if own := [name for name in columns if name[0] == letter]:
                names |= dict(zip(own, self.of(key, own), strict=True))
        if missing := [name for name in names.values() if name not in self.references]:
            raise Fault(
                f"expected outputs {' '.join(names)}, got no {' '.join(missing)} @ FMU "
                "(name its own by ?omega=NAME,NAME,NAME)"
            )
        return [self.references[names[name]] for name in columns]


def points(elapsed: Sequence[float], longest: float, varies: bool) -> Iterator[list[float]]:
    """Yield the communication points up to each sample: whole steps of equal length, the last one at it."""
    lengths = []
    for before, instant in pairwise([0.0, *elapsed]):
        span = instant - before
        count = math.ceil(span / longest * (1 - _EQUAL)) if span > 0 else 0
        if not count:
            yield []
            continue
        lengths.append(span / count)
        yield [*(before + k * span / count for k in range(1, count)), instant]
    if not varies and lengths and max(lengths) - min(lengths) > _EQUAL * max(lengths):
        raise Fault(
            f"expected a step that divides every distance of samples, got {longest:g} @ step (this FMU "
            f"cannot vary its step: it would need {min(lengths):.17g} and {max(lengths):.17g})"
        )


def run(path: str, folder: str, settings: Any, question: Any) -> dict[str, Any]:
    """Return the answer of the protocol."""
    import fmpy
    from fmpy.simulation import instantiate_fmu

    description = fmpy.read_model_description(path)
    slave = description.coSimulation
    if slave is None or description.fmiVersion == "1.0":
        raise Fault(f"expected an FMU for co-simulation of FMI 2 or 3, got none @ {path}")
    variables = Variables(description, settings["names"])
    inputs = dict(variables.settings(question, settings["fixed"]))
    columns = question["columns"][1:]
    outputs = variables.outputs(columns)
    default = getattr(description.defaultExperiment, "stepSize", None)
    step = float(settings["step"] or default or 0)
    if not step > 0:
        raise Fault("expected ?step=NUMBER, got none, and the FMU has no step of its own @ step")
    elapsed = floats(question["time"]["elapsed"])
    ways = list(points(elapsed, step, bool(slave.canHandleVariableCommunicationStepSize)))
    fmpy.extract(path, unzipdir=folder)
    fmu = instantiate_fmu(folder, description, "CoSimulation")
    is_new = description.fmiVersion.startswith("3")
    write, get = (fmu.setFloat64, fmu.getFloat64) if is_new else (fmu.setReal, fmu.getReal)
    if not is_new:
        fmu.setupExperiment(startTime=0.0)
    write(list(inputs), list(inputs.values()))
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    rows, now, began = [], 0.0, perf_counter()
    for way in ways:
        for point in way:
            fmu.doStep(currentCommunicationPoint=now, communicationStepSize=point - now)
            now = point
        rows.append([float(value).hex() for value in get(outputs)])
    return {
        "t": question["time"]["times"]["hex"],
        "steps": sum(map(len, ways)),
        "seconds": perf_counter() - began,
        **dict(zip(columns, zip(*rows, strict=True), strict=True)),
    }


def main() -> None:
    """Answer the question on standard input; what the FMU prints goes to standard error."""
    answers = os.dup(1)
    os.dup2(2, 1)
    path, folder, settings = sys.argv[1:]
    try:
        answer = run(path, folder, json.loads(settings), json.load(sys.stdin))
    except Exception as error:  # a stranger's file and its code: what they raise is told in a line
        sys.exit(str(error) or type(error).__name__)
    with os.fdopen(answers, "w") as out:
        json.dump(answer, out)
        out.flush()
        # The library of an FMU may not survive its unloading.
        os._exit(0)


if __name__ == "__main__":
    main()
