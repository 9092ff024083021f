"""The pieces of a dense answer, whatever holds it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from taylor_verify.certify.dense import (
    columns_of,
    components,
    is_piecewise,
    of_document,
    of_mapping,
    of_ode_solution,
    of_scipy,
    of_taylor,
)
from taylor_verify.certify.pieces import Pieces
from taylor_verify.certify.samples import of_callable, of_samples
from taylor_verify.records.faults import brief, refusal
from taylor_verify.records.json_text import exact_document
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.assigned import Request
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.objects import trajectory

_DOCUMENT: Final = frozenset(("breaks", "quantities"))


def pieces_of(
    answer: Any,
    scene: Scene,
    degree: Any = None,
    nodes: Any = None,
    interpolation: Any = None,
    columns: Request = (),
) -> Pieces:
    """Return the pieces of an answer. Raises Refused for what is none, and ValueError as `check` does."""
    if isinstance(answer, str | os.PathLike):
        document = _document(answer)
        if document is None:
            return of_samples(read(answer, columns, scene), scene, interpolation)
        answer = document
    if columns and interpolation is None:
        raise refusal("columns with samples and their interpolation", "them with pieces", "columns")
    if isinstance(answer, Pieces):
        return answer
    if interpolation is not None:
        return of_samples(trajectory(answer, scene, columns), scene, interpolation)
    if hasattr(answer, "sol") and hasattr(answer, "t"):
        if answer.sol is None:
            raise refusal("a dense answer: solve_ivp(.., dense_output=True)", "None", "answer.sol")
        answer = answer.sol
    return _of_object(answer, scene, degree, nodes)


def _of_object(answer: Any, scene: Scene, degree: Any, nodes: Any) -> Pieces:
    if hasattr(answer, "interpolants") and hasattr(answer, "ts"):
        return of_ode_solution(answer, scene)
    if hasattr(answer, "tcs") and hasattr(answer, "times"):
        return of_taylor(answer, scene)
    if is_piecewise(answer):
        return of_scipy(answer, columns_of(scene, components(answer)))
    if isinstance(answer, Mapping) and set(answer) >= _DOCUMENT:
        return of_document(answer, scene)
    if isinstance(answer, Mapping) and answer and all(map(is_piecewise, answer.values())):
        return of_mapping(answer, scene)
    if callable(answer):
        return of_callable(answer, scene, degree, nodes)
    expected = (
        "a dense answer (polynomials on pieces, a callable with degree and nodes, samples with "
    )
    raise refusal(f"{expected}interpolation)", brief(answer), "answer")


def _document(file: str | os.PathLike[str]) -> Mapping[str, Any] | None:
    """Return the pieces in a JSON file; None for any other file."""
    path = Path(file)
    if path.suffix.lower() != ".json" or not path.is_file():
        return None
    document = exact_document(path)
    return document if isinstance(document, dict) and set(document) >= _DOCUMENT else None
