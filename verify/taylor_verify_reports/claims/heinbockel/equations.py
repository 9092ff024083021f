"""Heinbockel (2.2.67)-(2.2.72): from the angular momentum in space to Euler's equations.

I, w, M    inertia tensor, angular velocity and moment in body axes (Heinbockel's barred ones); dw is
           the rate of w, free symbols
l          l_ip: component along space axis i of body axis p, so that v_i = l_ip v-bar_p
H          I w, body axes
s          a particle of the body, in space axes, which moves with it
epsilon    e_ijk; dual(v) is e_rmn v_r, a vector as an antisymmetric tensor: H_mn, M_mn, w_mn
rank4(I)   I_mnst = e_jmn e_ist I_ij/2, so that H_mn = I_mnst w_st, a tensordot
law        dH_r/dt - M_r in space axes: what Newton's law sets to zero. As dw is free, it is not zero
           here, and an equation of motion is checked by what it makes of the law

Every form is compared with the law for a free rate of w, so that none rests on another, and none on a
form of Euler's equations used elsewhere in this suite.
"""

from __future__ import annotations

from typing import Final

from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.field import values
from taylor_verify_reports.claims.setting import QUATERNION, UNIT, Exact

_MOTION: Final = """
dual = lambda v: einsum("rmn,r->mn", epsilon, v)
rank4 = lambda I: einsum("jmn,ist,ij->mnst", epsilon, epsilon, I) / 2
l = rotation(e0, e1, e2, e3)
turn(**quaternion_rates(e0, e1, e2, e3, w), w=dw, s=cross(l @ w, s))
H = I @ w
law = d(l @ H) - l @ M
euler = I @ dw + cross(w, H) - M
left_of_70 = einsum("im,i->m", I, dw) - einsum("tmj,ij,i,t->m", epsilon, I, w, w)
# The two products of (2.2.69), by the indices p q alpha beta u v.
first = einsum("au,pv,bq->pqabuv", delta, delta, delta)
second = einsum("pa,bu,qv->pqabuv", delta, delta, delta)
particle = lambda s: (s @ s) * delta - outer(s, s)
"""
_VECTORS: Final = tuple(f"{letter}{k}" for letter in ("w", "dw", "M", "s") for k in "123")
_SIX: Final = tuple(f"I{jk}" for jk in ("11", "12", "13", "22", "23", "33"))
_NINE: Final = tuple(f"I{j}{k}" for j in "123" for k in "123")

rigid: Final = Exact({**QUATERNION, **values((*_VECTORS, *_SIX))}, _MOTION, UNIT)
# Nine free entries of I, without I_ij = I_ji.
unsymmetric: Final = Exact({**QUATERNION, **values((*_VECTORS, *_NINE))}, _MOTION, UNIT)
principal: Final = Exact(
    {**QUATERNION, **values((*_VECTORS, "I11", "I22", "I33"))},
    "I = diag([I11, I22, I33])" + _MOTION,
    UNIT,
)

_69: Final = (
    "tensordot(rank4(I), dual(dw)) "
    "+ einsum('pqabuv,ab,uv->pq', first + second, tensordot(rank4(I), dual(w)), dual(w))"
)

_EXACT: Final = "exact expansion in I, w, w', M and the quaternion, with w' free"
_FLAT: Final = "the fraction lies flat"
_BARS: Final = "the bars over what belongs to the body axes, and the fraction"

CLAIMS: Final = (
    Claim(
        id="heinbockel (2.2.67)",
        statement=r"\frac{dH_{ij}}{dt} = M_{ij}",
        domain="inertial axes; H_ij = e_rij H_r, M_ij = e_rij M_r",
        method=f"equivalent to dH_r/dt = M_r; {_EXACT}",
        lost=_FLAT,
        check=rigid(
            "d(dual(l @ H)) - dual(l @ M) = dual(law)",
            "einsum('rmn,mn->r', epsilon, dual(law)) = 2*law",
        ),
        mutants={
            "M_ji for M_ij": ("dual(l @ M)", "dual(l @ M).T"),
            "body axes": ("d(dual(l @ H)) - dual(l @ M)", "d(dual(H)) - dual(M)"),
        },
    ),
    Claim(
        id="heinbockel momentum tensor",
        statement=r"H_{mn} = e_{imn}\omega_jI_{ji} = I_{mnst}\omega_{st}",
        domain="any axes; I_mnst = e_jmn e_ist I_ij/2, w_st = e_kst w_k",
        method=f"H_mn = e_imn H_i with H = I w; {_EXACT}",
        check=rigid(
            "dual(H) = einsum('imn,j,ji->mn', epsilon, w, I) = tensordot(rank4(I), dual(w))"
        ),
        mutants={
            "2 w_st": ("dual(w)", "2*dual(w)"),
            "w_ts for w_st": ("dual(w)", "dual(w).T"),
        },
    ),
    Claim(
        id="heinbockel (2.2.68)",
        statement=r"\frac{d}{dt}(I_{ijst}\omega_{st}) = M_{ij}",
        domain="inertial axes, in which I_ijst depends on time",
        method=f"equivalent to dH_r/dt = M_r; {_EXACT}",
        lost=_FLAT,
        check=rigid("d(tensordot(rank4(l @ I @ l.T), dual(l @ w))) = dual(l @ M) + dual(law)"),
        mutants={
            "2 M_ij": ("dual(l @ M)", "2*dual(l @ M)"),
            "I_ijst and w_st in body axes": (
                "rank4(l @ I @ l.T), dual(l @ w)",
                "rank4(I), dual(w)",
            ),
        },
    ),
    Claim(
        id="heinbockel constant inertia",
        statement=r"\text{in the barred system } \bar I_{pqrs} \text{ will be a constant and its "
        r"derivative will be zero}",
        domain="barred axes fixed in the body; the bar is lost in the scan, and with it the point",
        method="the inertia of any particle that moves with the body, s' = w x s; exact expansion",
        lost="the bar over I",
        check=rigid("d(rank4(particle(l.T @ s))) = 0"),
        mutants={"without the bar": ("l.T @ s", "s")},
    ),
    Claim(
        id="heinbockel transformation equations",
        statement=r"I_{ijst} = \ell_{ip}\ell_{jq}\ell_{sr}\ell_{tk}\bar I_{pqrk},\quad "
        r"\bar\omega_{ij} = \ell_{si}\ell_{tj}\omega_{st},\quad "
        r"\bar M_{pq} = \ell_{ip}\ell_{jq}M_{ij}",
        domain="l_ip the cosine between space axis i and body axis p",
        method="all components, from I = l I-bar l^T and v = l v-bar; exact expansion in the quaternion",
        lost="the bars",
        check=rigid(
            "rank4(l @ I @ l.T) = einsum('ip,jq,sr,tk,pqrk->ijst', l, l, l, l, rank4(I), optimize=True)",
            "einsum('si,tj,st->ij', l, l, dual(l @ w)) = dual(w)",
            "einsum('ip,jq,ij->pq', l, l, dual(l @ M)) = dual(M)",
        ),
        mutants={"the transposed l": ("l, l, l, l", "l.T, l.T, l.T, l.T")},
    ),
    Claim(
        id="heinbockel carried law",
        statement=r"\ell_{ip}\ell_{jq}\frac{d}{dt}\big(\ell_{i\alpha}\ell_{j\beta}"
        r"\bar I_{\alpha\beta rk}\bar\omega_{rk}\big) = \bar M_{pq}",
        domain="barred axes fixed in the body",
        method=f"equivalent to dH_r/dt = M_r; {_EXACT}",
        lost=_BARS,
        check=rigid(
            "l.T @ d(l @ tensordot(rank4(I), dual(w)) @ l.T) @ l = dual(M) + dual(l.T @ law)"
        ),
        mutants={
            "without the cosines": rigid(
                "d(tensordot(rank4(I), dual(w))) = dual(M) + dual(l.T @ law)"
            ),
        },
    ),
    Claim(
        id="heinbockel (2.2.69)",
        statement=r"\bar I_{pqrk}\frac{d\bar\omega_{rk}}{dt} + (\delta_{\alpha u}\delta_{pv}"
        r"\delta_{\beta q} + \delta_{p\alpha}\delta_{\beta u}\delta_{qv})\bar I_{\alpha\beta rk}"
        r"\bar\omega_{rk}\bar\omega_{uv} = \bar M_{pq}",
        domain="barred axes fixed in the body; w-bar_mn = l_jn dl_jm/dt = e_kmn w-bar_k",
        method=f"equivalent to dH_r/dt = M_r; {_EXACT}",
        lost=_BARS,
        check=rigid("d(l).T @ l = dual(w)", f"{_69} = dual(M) + dual(euler)"),
        mutants={
            "w_vu for w_uv": ("dual(w)), dual(w))", "dual(w)), dual(w).T)"),
            "without the second term": ("first + second", "first"),
        },
    ),
    Claim(
        id="heinbockel (2.2.70)",
        statement=r"\bar I_{im}\frac{d\bar\omega_i}{dt} - e_{tmj}\bar I_{ij}\bar\omega_i\bar\omega_t "
        r"= \bar M_m",
        domain="barred axes fixed in the body",
        method=f"equivalent to dH_r/dt = M_r, and e_mpq on (2.2.69) is twice it; {_EXACT}",
        lost=_BARS,
        check=rigid(
            "einsum('im,i->m', I, dw) - einsum('tmj,ij,i,t->m', epsilon, I, w, w) = M + l.T @ law",
            f"einsum('mpq,pq->m', epsilon, {_69} - dual(M)) = 2*(l.T @ law)",
        ),
        mutants={
            "+ e_tmj": ("- einsum('tmj", "+ einsum('tmj"),
            "e_mpq on (2.2.69) once": ("2*(l.T @ law)", "l.T @ law"),
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
        lost="nine fractions lie flat above their rows",
        check=unsymmetric(
            "I11*dw1 + I21*dw2 + I31*dw3 + (I13*w1 + I23*w2 + I33*w3)*w2 - (I12*w1 + I22*w2 + I32*w3)*w3"
            " = left_of_70[0]",
            "I12*dw1 + I22*dw2 + I32*dw3 + (I11*w1 + I21*w2 + I31*w3)*w3 - (I13*w1 + I23*w2 + I33*w3)*w1"
            " = left_of_70[1]",
            "I13*dw1 + I23*dw2 + I33*dw3 + (I12*w1 + I22*w2 + I32*w3)*w1 - (I11*w1 + I21*w2 + I31*w3)*w2"
            " = left_of_70[2]",
        ),
        mutants={
            "the sign of the last bracket": ("- (I12*w1", "+ (I12*w1"),
            "I32 for I33": ("I33*w3)*w2", "I32*w3)*w2"),
        },
    ),
    Claim(
        id="heinbockel (2.2.72)",
        statement=r"I_{11}\dot\omega_1 + (I_{33} - I_{22})\omega_2\omega_3 = M_1,\quad "
        r"I_{22}\dot\omega_2 + (I_{11} - I_{33})\omega_3\omega_1 = M_2,\quad "
        r"I_{33}\dot\omega_3 + (I_{22} - I_{11})\omega_1\omega_2 = M_3",
        domain="principal axes fixed in the body, I_ij = 0 for i != j",
        method=f"equivalent to dH_r/dt = M_r with the products of inertia zero; {_EXACT}",
        lost="three fractions lie flat above their rows; i 6= j stands for i != j",
        check=principal(
            "[I11*dw1 + (I33 - I22)*w2*w3, I22*dw2 + (I11 - I33)*w3*w1, I33*dw3 + (I22 - I11)*w1*w2]"
            " = M + l.T @ law"
        ),
        mutants={
            "I22 - I33": ("I33 - I22", "I22 - I33"),
            "the sign of the second row": ("+ (I11 - I33)", "- (I11 - I33)"),
        },
    ),
)
