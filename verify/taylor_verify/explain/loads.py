"""The loads of a scene along its motion: each term with its size, its work and its price."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from time import perf_counter
from typing import Any, Final

import numpy as np

from taylor_verify.exact.conditioning.condition import Path
from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.registry import kind_of
from taylor_verify.judge.floor.loads import Along, Floats
from taylor_verify.judge.load_notes import NOTHING_CONSERVED
from taylor_verify.records.quantities import TRACKED
from taylor_verify.scenes.loads.loads import VECTORS, Loads
from taylor_verify.scenes.scene import Scene

# An evaluation is timed as often as this, and the fastest counts.
_REPEATS: Final = 3
_KINDS: Final = {"+": "sums", "-": "sums", "*": "products", "/": "quotients"}
_DATA: Final = ("number", "input", "pi")


def loads_document(scene: Scene, path: Path) -> dict[str, Any]:
    """Return what is conserved, and the terms of the loads along an orbit of the scene.

    Sizes and work are those of float64 at the times of the path; the work is by the trapezium rule.
    """
    loads = path.scene.body.loads
    assert loads is not None
    whole = _Acting(path, loads)
    return {
        "conserved": list(conserved(scene)),
        "switches": len(loads.switches),
        "free": _sizes(path, whole.free),
        "terms": [_term(path, *term) for term in terms(loads)],
        "work": float(whole.work),
        "operations": operations(loads),
    }


def conserved(scene: Scene) -> Iterator[str]:
    """Yield a sentence for each quantity that the loads conserve, or that none was found."""
    gated = {each.name for each in invariants(scene)}
    whole = replace(scene, track=frozenset(TRACKED[scene.model]))
    formulas = {each.name: each.because for each in invariants(whole) if each.is_conserved}
    for name, formula in formulas.items():
        yield (
            formula if name in gated else f"{formula} (not gated: the scene does not track enough)"
        )
    if not formulas:
        yield NOTHING_CONSERVED


# Terms.


def terms(loads: Loads) -> Iterator[tuple[str, str, Loads]]:
    """Yield each summand of the loads: its place in the scene, its text, and loads that have it alone.

    Those are the forces that hang on the body, and the summands of each text and number.
    """
    alone = replace(loads, vectors=(), hung=())
    for hung in loads.hung:
        force, at = (", ".join(map(str, vector)) for vector in hung)
        yield "hung", f"force ({force}) at ({at})", replace(alone, hung=(hung,))
    for name, entries in loads.vectors:
        for i, entry in enumerate(entries):
            for text in summands(entry) if isinstance(entry, str) else filter(None, [entry]):
                vector = tuple(text if k == i else Fraction(0) for k in range(3))
                yield f"{name}[{i}]", str(text), replace(alone, vectors=((name, vector),))


def summands(text: str) -> list[str]:
    """Return the summands of an expression, each with its sign."""
    powers = text.replace("^", "**")
    return [_signed(powers, *each) for each in _parts(ast.parse(powers.strip(), mode="eval").body)]


def _parts(node: ast.expr, is_negative: bool = False) -> Iterator[tuple[ast.expr, bool]]:
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
        yield from _parts(node.left, is_negative)
        yield from _parts(node.right, is_negative != isinstance(node.op, ast.Sub))
    else:
        yield node, is_negative


def _signed(text: str, node: ast.expr, is_negative: bool) -> str:
    segment = ast.get_source_segment(text.strip(), node) or ""
    if not is_negative:
        return segment
    is_product = isinstance(node, ast.BinOp | ast.Name | ast.Call | ast.Constant)
    return f"-{segment}" if is_product else f"-({segment})"


def operations(loads: Loads) -> Mapping[str, int]:
    """Return the operations of one evaluation, by kind; in the first piece of time."""
    steps = loads.piece(Fraction(0)).steps
    kinds = (
        _KINDS.get(step.operation, "functions") for step in steps if step.operation not in _DATA
    )
    counted = Counter(kinds)
    return {name: counted[name] for name in ("sums", "products", "quotients", "functions")}


# Along the motion.


@dataclass(frozen=True)
class _Acting:
    """Some loads along the motion of a path that all loads made."""

    path: Path
    loads: Loads

    @cached_property
    def along(self) -> Along:
        body = self.path.scene.body.with_loads(self.loads)
        return Along(replace(self.path, scene=replace(self.path.scene, body=body)))

    @cached_property
    def forces(self) -> Floats:
        return self.along.forces()

    @property
    def free(self) -> Floats:
        """The rates of the momenta without loads."""
        momentum = kind_of(self.along.body).momentum_matrix(self.along.body).astype(float)
        rate, _, _ = self.along.rates()
        free: Floats = rate @ momentum.T - self.forces
        return free

    @property
    def work(self) -> float:
        """The integral of the power until the end."""
        body, z = self.along.body, self.along.state
        kind = kind_of(body)
        pushed = self.forces @ np.array(kind.pushed(body), dtype=float).T
        power = np.sum(pushed * (z @ np.array(kind.energy(body), dtype=float).T), axis=1)
        return float(np.trapezoid(power, [float(t) for t in self.path.elapsed]))

    def seconds(self) -> float:
        """Return the time of an evaluation at one row, of many at once in float64."""
        times = []
        for _ in range(_REPEATS):
            began = perf_counter()
            self.along.forces()
            times.append(perf_counter() - began)
        return min(times) / len(self.path.elapsed)


def _term(path: Path, place: str, text: str, loads: Loads) -> dict[str, Any]:
    acting = _Acting(path, loads)
    return {
        "place": place,
        "text": text,
        **_sizes(path, acting.forces),
        "work": acting.work,
        "operations": operations(loads),
        "seconds": acting.seconds(),
    }


def _sizes(path: Path, rows: Floats) -> dict[str, Any]:
    """Return the largest norm of each vector of three with its time, and the root mean square."""
    vectors = VECTORS[path.scene.model]
    document: dict[str, Any] = {}
    for k, name in enumerate(vectors):
        norms = np.linalg.norm(rows[:, 3 * k : 3 * k + 3], axis=1)
        worst = int(np.argmax(norms))
        document[name] = {
            "largest": float(norms[worst]),
            "at": float(path.scene.clock.start + path.elapsed[worst]),
            "mean": float(np.sqrt(np.mean(norms**2))),
        }
    return document
