"""The ledger: every numbered equation and every claim in words of the two source texts, checked.

The texts are a page of Heinbockel's tensor calculus (Euler's equations) and sections 48 and 49 of the
Encyclopaedia Britannica's Hydromechanics (Kirchhoff's equations), both as transcribed: a fault may
be the print's or the transcription's. Nothing here imports models or solvers.
"""

from __future__ import annotations

from taylor_verify_reports.claims.claim import Finding


def claims(*ids: str) -> list[Finding]:
    """Examine the claims of these ids, or all of them, and return the findings.

    Parameters
    ----------
    ids
        Ids of claims. A part that begins or ends an id stands for all that it fits:
        ``"hydromechanics 49"``, ``"(2.2.70)"``.

    Returns
    -------
    list of claims.claim.Finding
        The claim, the verdict that its check gives now, and the residuals that this rests on. All of them
        take about half a minute.

    Raises
    ------
    ValueError
        For ids that no claim has.
    """
    from taylor_verify_reports.claims.ledger import examined, find

    return examined(find(ids))
