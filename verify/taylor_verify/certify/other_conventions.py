"""Conventions of a dense answer that are not the scene's: it is refused, as no bound would tell."""

from __future__ import annotations

from typing import Final

from taylor_verify.certify.pieces import Pieces, nearest
from taylor_verify.numbers.precision import rung
from taylor_verify.records.certificate import Certified
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.scene import Scene

# Errors below this are not those of another unit, sign or order.
_LARGE: Final = 1e-3
_MOST_ROWS: Final = 60


def check_conventions(scene: Scene, pieces: Pieces, certificate: Certified) -> None:
    """Raise Refused if values of a wrong answer at its nodes fit the scene by another convention."""
    if not any(bound > _LARGE for bound in certificate.bound.values()):
        return
    from taylor_verify.judge.files.judgement import judge_file
    from taylor_verify.solvers.files.objects import trajectory

    every = pieces.each[:: max(1, len(pieces.each) // _MOST_ROWS)]
    table = {"t": [float(piece.begin) for piece in every]}
    for column in pieces.columns:
        table[column] = [nearest(piece.polynomials[column][0]) for piece in every]
    if len(every) < 2:
        return
    judgement = judge_file(trajectory(table, scene), scene, rung("f64"), partial=True)
    if judgement.conventions:
        got = "; ".join(finding.sentence for finding in judgement.conventions)
        raise Refused([f"expected the conventions of the scene, got others: {got} @ answer"])
