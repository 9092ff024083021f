"""The equations and sentences of the two texts, in their order: written from the texts, not the entries.

``NUMBERED`` are the equations that carry a number, ``SENTENCES`` the claims that are made in words or
without a number, by short names. ``CITED`` are numbers that a text refers to but does not show.
"""

from __future__ import annotations

import re
from typing import Final

_TEXTS: Final = {
    "heinbockel": """
        (2.2.67), momentum tensor
        (2.2.68), constant inertia, transformation equations, carried law
        (2.2.69), (2.2.70), (2.2.71)
        (2.2.72), constant moments""",
    # (3) stands above the first line of the scan, but is spoken of below (iii); of (4) the number is left.
    "hydromechanics 48": """
        (3), (4), (5), (6), (7), (8), (9), (i), (ii), (iii), constant vector
        (10), couple perpendicular to F, component along OF, reducible to a quadrature
        limited series of cases, double-theta function""",
    "hydromechanics 49": """
        (1), most general energy
        (2), (3), (4), (5), (6), (7), (8), elliptic time
        (9), (10), (11), (12), (13), third kind in (13)
        (14), (15), (16), (17), third kind in (17)
        (18), (19), (20), coordinate Z
        (21), (22), (23), (24), (25), stable if A is negative, nutations per second
        (26), case B^2 < AC, falls away ultimately
        (27), (28), (29), algebraic motion, centre from (22)""",
}

IN_ORDER: Final = tuple(
    f"{text} {name.strip()}"
    for text, names in _TEXTS.items()
    for name in re.split(r",|\n", names.strip())
)
NUMBERED: Final = tuple(id for id in IN_ORDER if re.fullmatch(r"[a-z]+( \d+)? \(\S+\)", id))
SENTENCES: Final = tuple(id for id in IN_ORDER if id not in NUMBERED)

CITED: Final = {
    "heinbockel (2.2.42)": "H in terms of I and omega, on a page before; read as H_i = I_ij omega_j",
    "heinbockel (2.2.49)": "the law on a page before; read as dH_r/dt = M_r",
    "heinbockel (2.2.61)": "of omega_ij, on a page before",
    "heinbockel (2.2.64)": "of omega_ij, on a page before; read as omega_mn = e_kmn omega_k",
    "heinbockel (2.2.66)": "of I_mnst, on a page before; read as I_mnst = e_jmn e_ist I_ij/2",
}
