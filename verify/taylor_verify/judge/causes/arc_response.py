"""Response of arcs to other rates, to first order: one evaluation in place of a flow.

Rates that differ by d(t) along the arc of the right equations change its end by the integral of
Phi(end, t) d(t), where Phi is the flow of small differences. Gauss's three points give the integral.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, Evidence, moved
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.many_flows import Floats

_POINTS: Final = (0.5 - 0.15**0.5, 0.5, 0.5 + 0.15**0.5)
_WEIGHTS: Final = (5 / 18, 8 / 18, 5 / 18)
# A small difference, as a part of the size of a component.
_SMALL: Final = 1e-6
# A change is asked for once more, by a flow, if it is so much along the defects (the cosine).
_ALONG: Final = 0.5
# Arcs without a switch have at least this part of the defects, or all changes are asked for by flows.
_SMOOTH: Final = 0.7


def sketched_rests(evidence: Evidence, sets: Sequence[Changes]) -> list[Floats]:
    """Return what each set of changes leaves of the defects, nearly; other texts have a flow each.

    Of those that do not lead towards the answer the response of the arcs tells enough.
    """
    rests = dict[int, Floats]()
    if isinstance(evidence, Arcs) and evidence.answer.stepping is None and _is_smooth(evidence):
        right = evidence.answer.right
        other = {k: right.changed(own) for k, own in enumerate(sets) if "acting" in own}
        response = ArcResponse.of(evidence, other.values())
        of_right = evidence.of_right
        for k, equations in other.items():
            change = np.zeros_like(of_right)
            change[:, : len(evidence.first)] = response.compared(equations)
            size = float(np.linalg.norm(change)) * evidence.size
            if not float(np.sum(change * of_right)) > _ALONG * size:
                rests[k] = of_right - change
    flows = [k for k in range(len(sets)) if k not in rests]
    first, *every = evidence.sketched([{}, *(sets[k] for k in flows)])
    by_flow = (evidence.of_right + defects - first for defects in every)
    rests |= zip(flows, by_flow, strict=True)
    return [rests[k] for k in range(len(sets))]


def _is_smooth(arcs: Arcs) -> bool:
    of_smooth = arcs.of_right[:, : len(arcs.first)][:, ~arcs.have_switch]
    return float(np.linalg.norm(of_smooth)) > _SMOOTH * arcs.size


@dataclass(frozen=True)
class ArcResponse:
    """The change of the ends of arcs by other equations, for all components that the file has."""

    arcs: Arcs
    count: int

    @classmethod
    def of(cls, arcs: Arcs, others: Iterable[Equations]) -> ArcResponse:
        """Return the response with the components that the file has, or that some equations depend on."""
        coupled = (each.coupled for each in (arcs.answer.right, *others))
        return cls(arcs, max(arcs.compared, *coupled))

    def compared(self, equations: Equations) -> Floats:
        """Return the change of the defects by one set of equations, (components, arcs)."""
        answer, (times, states, _) = self.arcs.answer, self._points
        answer.budget.spend(equations.price(self.count, len(times)))
        more = (equations.rates(times, states) - self._of_right)[0]
        points = more.reshape(len(more), len(_POINTS), -1)
        change = np.einsum("kica,ika->ca", self._weighed, points)[: self.arcs.compared]
        change[: answer.n] /= answer.sizes[:, None]
        change[answer.n + 4 :] /= answer.reach
        return np.asarray(change)

    @cached_property
    def _of_right(self) -> Floats:
        """The rates of the right equations at the points."""
        times, states, _ = self._points
        return self.arcs.answer.right.rates(times, states)

    @cached_property
    def _weighed(self) -> Floats:
        """The change of each end by rates at each point, (points, of components, components, arcs)."""
        (*_, flows), spans = self._points, self.arcs.spans
        to_end = accumulate(reversed(flows), lambda end, own: np.einsum("ija,jka->ika", own, end))
        return np.array(
            [weight * spans * flow for weight, flow in zip(_WEIGHTS, [*to_end][::-1], strict=True)]
        )

    @cached_property
    def _points(self) -> tuple[Floats, Floats, list[Floats]]:
        """Times and right states at the points, all arcs of one behind the other, and the flows onward.

        A flow is that of small differences from a point to the next, or to the end.
        """
        arcs, count = self.arcs, self.count
        right, sizes = arcs.answer.right, self._sizes
        steps, z = max(1, -(-arcs.few_steps // 4)), arcs.begin(count)
        since, states, flows, before = arcs.since, list[Floats](), list[Floats](), 0.0
        for point in (*_POINTS, 1.0):
            many = np.concatenate([z, z + _SMALL * sizes * np.eye(count)[:, :, None]])
            span = (point - before) * arcs.spans
            begin = many if states else z
            ends = moved(arcs.answer, right, begin, since + before * arcs.spans, span, steps)
            if states:
                flows.append((ends[1:] - ends[:1]) / (_SMALL * sizes))
            z, before = ends[:1], point
            states.append(z)
        times = np.concatenate([since + point * arcs.spans for point in _POINTS])
        return times, np.concatenate(states[: len(_POINTS)], axis=2), flows

    @property
    def _sizes(self) -> Floats:
        """The natural size of a difference in each component, (components, 1, 1)."""
        answer = self.arcs.answer
        sizes = [*answer.sizes, 1.0, 1.0, 1.0, 1.0, *[answer.reach] * 3]
        return np.array(sizes[: self.count])[:, None, None]
