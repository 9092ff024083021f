"""Proven bounds of the error of dense answers, for all times."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from taylor_verify import types


def certify(
    scene: types.Scene | str | os.PathLike[str],
    answer: Any,
    tolerance: float | None = None,
    degree: int | None = None,
    nodes: Any = None,
    interpolation: str | None = None,
    columns: Mapping[str, str] | Sequence[tuple[str, str]] = (),
) -> types.Certificate:
    """Return proven bounds of the error of a dense answer, for all times of the scene's span.

    The bound is that of the polynomials with the stored coefficients in real arithmetic; what their
    evaluation in float64 adds is bounded apart.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene. Its numbers are rounded to float64, as `check`
        does.
    answer
        SciPy's OdeResult or OdeSolution, a PPoly or a spline, or these by the names of quantities
        (``{"omega": CubicHermiteSpline(..)}``); heyoka's continuous output; a JSON file or a dict
        ``{"breaks": [..], "quantities": {"omega": [[[c0, c1, ..] for each component] for each piece]}}``
        with powers of t - break; a callable with ``degree`` and ``nodes``; a file or an object of samples
        with ``interpolation``. Components without names have the order of a state: omega, q0 .. q3.
    tolerance
        The error that is allowed, in the measures of `check`.
    degree, nodes
        The degree of the polynomial that a callable is between each two of these times.
    interpolation
        What a program makes of its samples: ``linear``, ``cubic`` (the spline of SciPy's CubicSpline) or
        ``hermite`` (cubics with the slopes of the scene's equations).
    columns
        The columns of samples by our names, as in `check`, or pairs of names.

    Returns
    -------
    certify.certificate.Certificate
        The bound of each quantity and the time near which it is reached; gaps, jumps and what else is wrong
        with the pieces.

    Raises
    ------
    records.faults.Refused
        For a scene or an answer that cannot be read: pieces that overlap, a degree over sixty, a callable
        without degree or that is no polynomial of it, other units.
    ValueError
        For a tolerance that is no positive finite number.
    """
    from taylor_verify.certify.bounds import certificate_of
    from taylor_verify.certify.dense_answer import pieces_of
    from taylor_verify.certify.other_conventions import check_conventions
    from taylor_verify.judge.tolerances import tolerances
    from taylor_verify.models.problem import pose_as_stored
    from taylor_verify.numbers.precision import rung
    from taylor_verify.scenes.reading.reader import as_scene

    scene = as_scene(scene)
    if tolerances(tolerance, [scene]).each:
        raise ValueError("expected one number for all quantities, got several @ tolerance")
    wanted = tuple(columns.items() if isinstance(columns, Mapping) else columns)
    pieces = pieces_of(answer, scene, degree, nodes, interpolation, wanted)
    given = pose_as_stored(scene, rung("f64")).given
    certificate = certificate_of(given, pieces, tolerance)
    check_conventions(scene, pieces, certificate)
    return certificate
