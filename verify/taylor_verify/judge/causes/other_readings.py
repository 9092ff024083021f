"""Answers read by other conventions, to be asked again for the cause of what these leave."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.inexact_conventions import FACTORS, SIGNED, axes
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.quaternion_rows import conjugate, matrices, steady_signs


def with_omega(answer: Answer, rows: Floats) -> Answer:
    v = answer.file.v.copy()
    v[:, answer.groups["omega"]] = rows
    return replace(answer, file=replace(answer.file, v=v))


def attitudes(answer: Answer) -> Iterator[tuple[str, Answer]]:
    """Yield conventions of the attitude, with the answer read by them."""
    q = answer.file.q
    if q is None:
        return
    last = np.roll(q, 1, axis=1)
    for name, rows in (
        ("is transposed: it takes space to body axes", conjugate(q)),
        ("is scalar last", last),
        ("is scalar last and transposed", conjugate(last)),
    ):
        yield name, replace(answer, file=replace(answer.file, q=steady_signs(rows)))


def rates(answer: Answer) -> Iterator[tuple[str, Answer]]:
    """Yield conventions of omega, with the answer read by them."""
    if answer.right.has_momenta:
        return
    omega = answer.file.v[:, answer.groups["omega"]]
    if answer.file.q is not None:
        in_body = np.einsum("nji,nj->ni", matrices(answer.file.q), omega)
        yield "is in space axes", with_omega(answer, in_body)
    for P in SIGNED[1:]:
        yield f"has other axes: {axes(P)}", with_omega(answer, omega @ P)
    for unit, factor in FACTORS.items():
        yield f"is in another unit: {unit}", with_omega(answer, omega / factor)
