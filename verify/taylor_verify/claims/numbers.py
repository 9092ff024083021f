"""What there is to check in the two texts, in their order: written from the texts, not from the entries.

``NUMBERED`` are the equations that carry a number, ``SENTENCES`` the claims that are made in words or
without a number, by short names. ``CITED`` are numbers that a text refers to but does not show.
"""

from __future__ import annotations

from typing import Final

_HEINBOCKEL: Final = tuple(f"heinbockel (2.2.{n})" for n in range(67, 73))
# (3) stands above the first line of the scan, but is spoken of below (iii); (4) has only its number left.
_SECTION_48: Final = (
    *(f"hydromechanics 48 ({n})" for n in range(3, 11)),
    *(f"hydromechanics 48 ({n})" for n in ("i", "ii", "iii")),
)
_SECTION_49: Final = tuple(f"hydromechanics 49 ({n})" for n in range(1, 30))

NUMBERED: Final = _HEINBOCKEL + _SECTION_48 + _SECTION_49

# What each of them is said after.
_SAID_AFTER: Final = {
    "heinbockel momentum tensor": "heinbockel (2.2.67)",
    "heinbockel constant inertia": "heinbockel (2.2.68)",
    "heinbockel transformation equations": "heinbockel constant inertia",
    "heinbockel carried law": "heinbockel transformation equations",
    "heinbockel constant moments": "heinbockel (2.2.72)",
    "hydromechanics 48 constant vector": "hydromechanics 48 (iii)",
    "hydromechanics 48 couple perpendicular to F": "hydromechanics 48 (10)",
    "hydromechanics 48 component along OF": "hydromechanics 48 couple perpendicular to F",
    "hydromechanics 48 reducible to a quadrature": "hydromechanics 48 component along OF",
    "hydromechanics 48 limited series of cases": "hydromechanics 48 reducible to a quadrature",
    "hydromechanics 48 double-theta function": "hydromechanics 48 limited series of cases",
    "hydromechanics 49 most general energy": "hydromechanics 49 (1)",
    "hydromechanics 49 elliptic time": "hydromechanics 49 (8)",
    "hydromechanics 49 third kind in (13)": "hydromechanics 49 (13)",
    "hydromechanics 49 third kind in (17)": "hydromechanics 49 (17)",
    "hydromechanics 49 coordinate Z": "hydromechanics 49 (20)",
    "hydromechanics 49 stable if A is negative": "hydromechanics 49 (25)",
    "hydromechanics 49 nutations per second": "hydromechanics 49 stable if A is negative",
    "hydromechanics 49 case B^2 < AC": "hydromechanics 49 (26)",
    "hydromechanics 49 falls away ultimately": "hydromechanics 49 case B^2 < AC",
    "hydromechanics 49 algebraic motion": "hydromechanics 49 (29)",
    "hydromechanics 49 centre from (22)": "hydromechanics 49 algebraic motion",
}
SENTENCES: Final = tuple(_SAID_AFTER)

CITED: Final = {
    "heinbockel (2.2.42)": "H in terms of I and omega, on a page before; read as H_i = I_ij omega_j",
    "heinbockel (2.2.49)": "the law on a page before; read as dH_r/dt = M_r",
    "heinbockel (2.2.61)": "of omega_ij, on a page before",
    "heinbockel (2.2.64)": "of omega_ij, on a page before; read as omega_mn = e_kmn omega_k",
    "heinbockel (2.2.66)": "of I_mnst, on a page before; read as I_mnst = e_jmn e_ist I_ij/2",
}


def in_order() -> tuple[str, ...]:
    """All of them in the order of the texts, (i)-(iii) between (9) and (10) as they are printed."""
    order = [*NUMBERED]
    last = "hydromechanics 48 (10)"
    order.remove(last)
    order.insert(order.index("hydromechanics 48 (iii)") + 1, last)
    for sentence, before in _SAID_AFTER.items():
        order.insert(order.index(before) + 1, sentence)
    return tuple(order)
