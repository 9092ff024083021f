"""Heinbockel (2.2.67)-(2.2.72): from the angular momentum in space to Euler's equations.

Symbols as in rigid.py. Every form is compared with the law dH/dt = M for a free rate of w, so that none
rests on another, and none on a form of Euler's equations used elsewhere in this suite.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from taylor_verify.claims.claim import Claim, Verdict
from taylor_verify.claims.field import Element, apply, dot, identity, minus, transposed
from taylor_verify.claims.heinbockel.rigid import (
    INDICES,
    PAIRS,
    RigidMotion,
    Tensor,
    antisymmetric,
    contracted,
    fourth_rank,
    permutation,
    turned,
    unsymmetric,
)


def _delta(i: int, j: int) -> int:
    return int(i == j)


def momentum_law(b: RigidMotion, swapped: bool = False, inertial: bool = True) -> Iterator[Element]:
    """(2.2.67), and that e_rjk on it gives the law back."""
    H, M = b.momentum, b.M
    if inertial:
        H, M = apply(b.l, H), apply(b.l, M)
    law, rates = antisymmetric(b.law), b.rates(antisymmetric(H))
    torque = antisymmetric(M)
    found: Tensor = {
        (m, n): rates[m, n] - (torque[n, m] if swapped else torque[m, n]) for m, n in PAIRS
    }
    yield from (found[key] - law[key] for key in PAIRS)
    for r in INDICES:
        yield _by_permutation(found, r) - 2 * b.law[r]


def _by_permutation(tensor: Any, r: int) -> Any:
    """e_rmn t_mn."""
    return sum((permutation(r, m, n) * tensor[m, n] for m, n in PAIRS), start=0)


def momentum_tensor(b: RigidMotion, factor: int = 1, transpose: bool = False) -> Iterator[Element]:
    """H_mn = e_imn w_j I_ji = I_mnst w_st."""
    H = antisymmetric(b.momentum)
    omega = antisymmetric([factor * w for w in b.w])
    if transpose:
        omega = {(m, n): omega[n, m] for m, n in PAIRS}
    second = contracted(fourth_rank(b.I), omega)
    for m, n in PAIRS:
        first = sum(
            (permutation(i, m, n) * b.w[j] * b.I[j][i] for i in INDICES for j in INDICES), start=0
        )
        yield b.field.element(H[m, n]) - first
        yield b.field.element(first) - second[m, n]


def spatial_tensor_law(b: RigidMotion, factor: int = 1, barred: bool = False) -> Iterator[Element]:
    """(2.2.68): I_ijst and w_st in space axes, where I_ijst depends on time."""
    inertia = b.I if barred else b.spatial_inertia
    omega = b.w if barred else apply(b.l, b.w)
    H = contracted(fourth_rank(inertia), antisymmetric(omega))
    torque = antisymmetric(apply(b.l, b.M))
    law, rates = antisymmetric(b.law), b.rates(H)
    yield from (rates[key] - factor * torque[key] - law[key] for key in PAIRS)


def constant_inertia(b: RigidMotion, barred: bool = True) -> Iterator[Element]:
    """d/dt of the inertia of a particle that moves with the body, s.s 1 - s s^T, in body axes."""
    s = apply(transposed(b.l), b.s) if barred else b.s
    inertia = [[_delta(i, j) * dot(s, s) - s[i] * s[j] for j in INDICES] for i in INDICES]
    yield from (b.field.rate(entry) for entry in fourth_rank(inertia).values())


def transformations(b: RigidMotion, inverted: bool = False) -> Iterator[Element]:
    """I_ijst = l l l l I-bar; w-bar_ij = l_si l_tj w_st; M-bar_pq = l_ip l_jq M_ij."""
    inertia, back = fourth_rank(b.spatial_inertia), transposed(b.l)
    moved = turned(fourth_rank(b.I), back if inverted else b.l)
    yield from (inertia[key] - moved[key] for key in inertia)
    for vector in (b.w, b.M):
        spatial = antisymmetric(apply(b.l, vector))
        found = turned(spatial, b.l if inverted else back)
        own = antisymmetric(vector)
        yield from (found[key] - own[key] for key in PAIRS)


def carried_law(b: RigidMotion, rotated: bool = True) -> Iterator[Element]:
    """l_ip l_jq d/dt (l_ia l_jb I-bar_abrk w-bar_rk) = M-bar_pq."""
    H = contracted(fourth_rank(b.I), antisymmetric(b.w))
    spatial = b.rates(turned(H, b.l) if rotated else H)
    found = turned(spatial, transposed(b.l)) if rotated else spatial
    torque, law = antisymmetric(b.M), antisymmetric(apply(transposed(b.l), b.law))
    yield from (found[key] - torque[key] - law[key] for key in PAIRS)


def expanded_law(b: RigidMotion, swapped: bool = False, both: bool = True) -> Iterator[Element]:
    """(2.2.69), with w_mn = l_jn dl_jm/dt = e_kmn w_k."""
    rates = [b.field.rates(row) for row in b.l]
    omega = antisymmetric(b.w)
    for m, n in PAIRS:
        spin = sum((b.l[j][n] * rates[j][m] for j in INDICES), start=0)
        yield spin - omega[n, m] if swapped else spin - omega[m, n]
    yield from (left - right for left, right in _expanded(b, swapped, both))


def _expanded(b: RigidMotion, swapped: bool, both: bool) -> Iterator[tuple[Any, Any]]:
    """Left side less M-bar_pq, and what the law makes of it."""
    inertia, omega = fourth_rank(b.I), antisymmetric(b.w)
    H, accelerated = contracted(inertia, omega), contracted(inertia, antisymmetric(b.dw))
    torque, law = antisymmetric(b.M), antisymmetric(b.euler)
    for p, q in PAIRS:
        turning: Any = 0
        for (u, v), (al, be) in ((uv, ab) for uv in PAIRS for ab in PAIRS):
            weight = _delta(al, u) * _delta(p, v) * _delta(be, q)
            weight += both * _delta(p, al) * _delta(be, u) * _delta(q, v)
            if weight:
                turning = turning + weight * H[al, be] * (omega[v, u] if swapped else omega[u, v])
        yield accelerated[p, q] + turning - torque[p, q], law[p, q]


def euler_tensor(b: RigidMotion, sign: int = 1, factor: int = 2) -> Iterator[Element]:
    """(2.2.70) against the law in body axes, and e_mpq on (2.2.69) is twice (2.2.70)."""
    law = apply(transposed(b.l), b.law)
    left = _left_of_70(b, sign)
    yield from (left[m] - b.M[m] - law[m] for m in INDICES)
    pairs = list(_expanded(b, swapped=False, both=True))
    found = dict(zip(PAIRS, (own for own, _ in pairs), strict=True))
    yield from (_by_permutation(found, m) - factor * (left[m] - b.M[m]) for m in INDICES)


def _left_of_70(b: RigidMotion, sign: int = 1) -> list[Any]:
    I, w, dw = b.I, b.w, b.dw
    return [
        sum((I[i][m] * dw[i] for i in INDICES), start=0)
        - sign
        * sum(
            (
                permutation(t, m, j) * I[i][j] * w[i] * w[t]
                for t in INDICES
                for j in INDICES
                for i in INDICES
                if permutation(t, m, j)
            ),
            start=0,
        )
        for m in INDICES
    ]


def euler_written_out(b: RigidMotion, sign: int = 1, index: int = 3) -> Iterator[Element]:
    """(2.2.71), row by row, against (2.2.70) with nine free entries of I."""
    (I11, I12, I13), (I21, I22, I23), (I31, I32, I33) = b.I
    (w1, w2, w3), (d1, d2, d3) = b.w, b.dw
    third = b.I[2][index - 1]
    rows = [
        I11 * d1 + I21 * d2 + I31 * d3
        + (I13 * w1 + I23 * w2 + third * w3) * w2
        - sign * (I12 * w1 + I22 * w2 + I32 * w3) * w3,
        I12 * d1 + I22 * d2 + I32 * d3
        + (I11 * w1 + I21 * w2 + I31 * w3) * w3
        - (I13 * w1 + I23 * w2 + I33 * w3) * w1,
        I13 * d1 + I23 * d2 + I33 * d3
        + (I12 * w1 + I22 * w2 + I32 * w3) * w1
        - (I11 * w1 + I21 * w2 + I31 * w3) * w2,
    ]  # fmt: skip
    yield from minus(rows, _left_of_70(b))


def euler_in_principal_axes(
    b: RigidMotion, sign: int = 1, swapped: bool = False
) -> Iterator[Element]:
    """(2.2.72), row by row, against the law in body axes with the products of inertia zero."""
    I1, I2, I3 = (b.I[k][k] for k in INDICES)
    (w1, w2, w3), (d1, d2, d3) = b.w, b.dw
    first = (I2 - I3) if swapped else (I3 - I2)
    rows = [
        I1 * d1 + first * w2 * w3,
        I2 * d2 + sign * (I1 - I3) * w3 * w1,
        I3 * d3 + (I2 - I1) * w1 * w2,
    ]
    law = apply(transposed(b.l), b.law)
    products = [f"I{j}{k}" for j, k in ("12", "13", "23")]
    yield from (rows[m] - b.M[m] - b.field.without(law[m], products) for m in INDICES)


_EXACT: Final = "exact expansion in I, w, w', M and the quaternion, with w' free"
_FLAT: Final = "the fraction lies flat"
_BARS: Final = "the bars over what belongs to the body axes, and the fraction"

CLAIMS: Final = (
    Claim(
        id="heinbockel (2.2.67)",
        statement=r"\frac{dH_{ij}}{dt} = M_{ij}",
        domain="inertial axes; H_ij = e_rij H_r, M_ij = e_rij M_r",
        method=f"equivalent to dH_r/dt = M_r; {_EXACT}",
        verdict=Verdict.RESTORED,
        lost=_FLAT,
        check=identity(RigidMotion, momentum_law),
        mutants={
            "M_ji for M_ij": identity(RigidMotion, momentum_law, swapped=True),
            "body axes": identity(RigidMotion, momentum_law, inertial=False),
        },
    ),
    Claim(
        id="heinbockel momentum tensor",
        statement=r"H_{mn} = e_{imn}\omega_jI_{ji} = I_{mnst}\omega_{st}",
        domain="any axes; I_mnst = e_jmn e_ist I_ij/2, w_st = e_kst w_k",
        method=f"H_mn = e_imn H_i with H = I w; {_EXACT}",
        verdict=Verdict.HOLDS,
        check=identity(RigidMotion, momentum_tensor),
        mutants={
            "2 w_st": identity(RigidMotion, momentum_tensor, factor=2),
            "w_ts for w_st": identity(RigidMotion, momentum_tensor, transpose=True),
        },
    ),
    Claim(
        id="heinbockel (2.2.68)",
        statement=r"\frac{d}{dt}(I_{ijst}\omega_{st}) = M_{ij}",
        domain="inertial axes, in which I_ijst depends on time",
        method=f"equivalent to dH_r/dt = M_r; {_EXACT}",
        verdict=Verdict.RESTORED,
        lost=_FLAT,
        check=identity(RigidMotion, spatial_tensor_law),
        mutants={
            "2 M_ij": identity(RigidMotion, spatial_tensor_law, factor=2),
            "I_ijst and w_st in body axes": identity(RigidMotion, spatial_tensor_law, barred=True),
        },
    ),
    Claim(
        id="heinbockel constant inertia",
        statement=r"\text{in the barred system } \bar I_{pqrs} \text{ will be a constant and its "
        r"derivative will be zero}",
        domain="barred axes fixed in the body; the bar is lost in the scan, and with it the point",
        method="the inertia of any particle that moves with the body, s' = w x s; exact expansion",
        verdict=Verdict.RESTORED,
        lost="the bar over I",
        check=identity(RigidMotion, constant_inertia),
        mutants={"without the bar": identity(RigidMotion, constant_inertia, barred=False)},
    ),
    Claim(
        id="heinbockel transformation equations",
        statement=r"I_{ijst} = \ell_{ip}\ell_{jq}\ell_{sr}\ell_{tk}\bar I_{pqrk},\quad "
        r"\bar\omega_{ij} = \ell_{si}\ell_{tj}\omega_{st},\quad "
        r"\bar M_{pq} = \ell_{ip}\ell_{jq}M_{ij}",
        domain="l_ip the cosine between space axis i and body axis p",
        method="all components, from I = l I-bar l^T and v = l v-bar; exact expansion in the quaternion",
        verdict=Verdict.RESTORED,
        lost="the bars",
        check=identity(RigidMotion, transformations),
        mutants={"the transposed l": identity(RigidMotion, transformations, inverted=True)},
    ),
    Claim(
        id="heinbockel carried law",
        statement=r"\ell_{ip}\ell_{jq}\frac{d}{dt}\big(\ell_{i\alpha}\ell_{j\beta}"
        r"\bar I_{\alpha\beta rk}\bar\omega_{rk}\big) = \bar M_{pq}",
        domain="barred axes fixed in the body",
        method=f"equivalent to dH_r/dt = M_r; {_EXACT}",
        verdict=Verdict.RESTORED,
        lost=_BARS,
        check=identity(RigidMotion, carried_law),
        mutants={"without the cosines": identity(RigidMotion, carried_law, rotated=False)},
    ),
    Claim(
        id="heinbockel (2.2.69)",
        statement=r"\bar I_{pqrk}\frac{d\bar\omega_{rk}}{dt} + (\delta_{\alpha u}\delta_{pv}"
        r"\delta_{\beta q} + \delta_{p\alpha}\delta_{\beta u}\delta_{qv})\bar I_{\alpha\beta rk}"
        r"\bar\omega_{rk}\bar\omega_{uv} = \bar M_{pq}",
        domain="barred axes fixed in the body; w-bar_mn = l_jn dl_jm/dt = e_kmn w-bar_k",
        method=f"equivalent to dH_r/dt = M_r; {_EXACT}",
        verdict=Verdict.RESTORED,
        lost=_BARS,
        check=identity(RigidMotion, expanded_law),
        mutants={
            "w_vu for w_uv": identity(RigidMotion, expanded_law, swapped=True),
            "without the second term": identity(RigidMotion, expanded_law, both=False),
        },
    ),
    Claim(
        id="heinbockel (2.2.70)",
        statement=r"\bar I_{im}\frac{d\bar\omega_i}{dt} - e_{tmj}\bar I_{ij}\bar\omega_i\bar\omega_t "
        r"= \bar M_m",
        domain="barred axes fixed in the body",
        method=f"equivalent to dH_r/dt = M_r, and e_mpq on (2.2.69) is twice it; {_EXACT}",
        verdict=Verdict.RESTORED,
        lost=_BARS,
        check=identity(RigidMotion, euler_tensor),
        mutants={
            "+ e_tmj": identity(RigidMotion, euler_tensor, sign=-1),
            "e_mpq on (2.2.69) once": identity(RigidMotion, euler_tensor, factor=1),
        },
    ),
    Claim(
        id="heinbockel (2.2.71)",
        statement=r"I_{11}\dot\omega_1 + I_{21}\dot\omega_2 + I_{31}\dot\omega_3 + (I_{13}\omega_1 "
        r"+ I_{23}\omega_2 + I_{33}\omega_3)\omega_2 - (I_{12}\omega_1 + I_{22}\omega_2 "
        r"+ I_{32}\omega_3)\omega_3 = M_1 \text{ and its two companions}",
        domain="axes fixed in the body; the bars dropped",
        method="the three rows against the sums of (2.2.70) with nine free entries of I, so that I_ij = "
        "I_ji is not used; exact expansion",
        verdict=Verdict.RESTORED,
        lost="nine fractions lie flat above their rows",
        check=identity(unsymmetric, euler_written_out),
        mutants={
            "the sign of the last bracket": identity(unsymmetric, euler_written_out, sign=-1),
            "I32 for I33": identity(unsymmetric, euler_written_out, index=2),
        },
    ),
    Claim(
        id="heinbockel (2.2.72)",
        statement=r"I_{11}\dot\omega_1 + (I_{33} - I_{22})\omega_2\omega_3 = M_1,\quad "
        r"I_{22}\dot\omega_2 + (I_{11} - I_{33})\omega_3\omega_1 = M_2,\quad "
        r"I_{33}\dot\omega_3 + (I_{22} - I_{11})\omega_1\omega_2 = M_3",
        domain="principal axes fixed in the body, I_ij = 0 for i != j",
        method=f"equivalent to dH_r/dt = M_r with the products of inertia zero; {_EXACT}",
        verdict=Verdict.RESTORED,
        lost="three fractions lie flat above their rows; i 6= j stands for i != j",
        check=identity(RigidMotion, euler_in_principal_axes),
        mutants={
            "I22 - I33": identity(RigidMotion, euler_in_principal_axes, swapped=True),
            "the sign of the second row": identity(RigidMotion, euler_in_principal_axes, sign=-1),
        },
    ),
)
