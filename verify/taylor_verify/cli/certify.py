"""The verb `certify`: a proven bound of the error of a dense answer."""

from __future__ import annotations

import argparse
from functools import partial
from typing import Any

from taylor_verify.certify import certify
from taylor_verify.certify.certificate import Certificate
from taylor_verify.cli.answer import (
    FAIL,
    PASS,
    UNDECIDED,
    Answer,
    CallParts,
    WrongCall,
    wrong_calls,
)
from taylor_verify.cli.console import titled
from taylor_verify.cli.inputs import parse_tolerance, read_scene, read_tolerances
from taylor_verify.cli.progress import working
from taylor_verify.records.json_text import complete
from taylor_verify.solvers.files.columns.assigned import request
from taylor_verify.words.certificate import certificate_lines, finding_sentence


def answer(options: argparse.Namespace) -> Answer:
    """Print the certificate of a file."""
    parts = CallParts()
    scene = parts.read(read_scene, options.scene)
    parts.read(read_tolerances, options.tolerance, None)
    parts.end()
    with wrong_calls():
        tolerance = parse_tolerance(options.tolerance)
        if isinstance(tolerance, dict):
            raise WrongCall("expected one number for all quantities, got several @ --tolerance")
        with working(f"certify {options.file}"):
            certificate = certify(
                scene,
                options.file,
                tolerance,
                interpolation=options.interpolation,
                columns=request(options.columns or ()),
            )
    messages = [certificate.because] if certificate.because else []
    status = PASS if certificate.passed else UNDECIDED if certificate.is_undecided else FAIL
    lines = certificate_lines(certificate)
    text = partial(titled, options.file, f" against {certificate.scene}", lines)
    failing = [] if certificate.passed else lines
    return Answer(status, document(certificate), text, messages, failing)


def document(certificate: Certificate) -> dict[str, Any]:
    """Return the certificate as JSON has it."""
    content = complete(certificate)
    because = {} if content.pop("because") == "" else {"because": certificate.because}
    findings = [finding_sentence(finding) for finding in certificate.findings]
    return {**content, "findings": findings, "passed": certificate.passed, **because}
