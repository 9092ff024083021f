"""A certificate in words."""

from __future__ import annotations

from taylor_verify.records.certificate import Certified, Fault, Gap, GapKind, InterpolantFinding


def certificate_lines(certificate: Certified) -> list[str]:
    """Return the lines of a certificate: bounds first, then what was found out."""
    lines = [certificate.because] if certificate.because else []
    for name, bound in certificate.bound.items():
        lines.append(
            f"{name}: off by at most {bound:.3e} for all t, near t = {certificate.at[name]:.6g}"
            f" (evaluating it in float64 adds at most {certificate.rounding[name]:.1e})"
        )
        if (tolerance := certificate.tolerance) is not None:
            lines[-1] += f"; {'within' if bound <= tolerance else 'beyond'} {tolerance:g}"
    lines += [finding_sentence(finding) for finding in certificate.findings]
    return [*lines, *gap_sentences(certificate.gaps)]


def finding_sentence(finding: InterpolantFinding) -> str:
    """Return the sentence on a fault."""
    sizes = f"nodes right to {finding.at_nodes:.1e}, between them {finding.between:.1e}"
    if finding.fault is Fault.BETWEEN:
        return f"{finding.quantity}: {sizes}: {finding.fault.value}"
    if finding.fault is Fault.SLOPES:
        return f"{finding.quantity}: {sizes}: {Fault.BETWEEN.value}: {finding.fault.value}"
    return f"{finding.quantity}: {Fault.BETWEEN.value}: {finding.fault.value}"


_MOST_GAPS = 5


def gap_sentences(gaps: tuple[Gap, ...]) -> list[str]:
    """Return a sentence for each gap; of many jumps the first ones."""
    lines = [_gap(gap) for gap in gaps[:_MOST_GAPS]]
    if len(gaps) > _MOST_GAPS:
        lines.append(f"and {len(gaps) - _MOST_GAPS} more gaps")
    return lines


def _gap(gap: Gap) -> str:
    match gap.kind:
        case GapKind.JUMP:
            return f"{gap.quantity}: a jump of {gap.size:.1e} at t = {gap.at:.17g}"
        case GapKind.NOT_COVERED:
            return f"not covered: from t = {gap.at:.17g} to {gap.end:.17g}"
    return f"{gap.quantity}: not in the answer"
