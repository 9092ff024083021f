"""Causes of other packages: a changed scene is a cause if its exact motion is the answer.

A plug-in of `taylor_verify.causes` has ``candidates(scene, answer)``, which yields scenes. Their titles say
what was changed. ``answer`` is a dict of arrays: the times and the quantities of the rows.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from fractions import Fraction
from typing import Any, Final

from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.material import ExactMotion
from taylor_verify.judge.causes.proof import LEAVES
from taylor_verify.records.plugins import Plugin, plugins
from taylor_verify.scenes.scene import Scene

_MOST: Final = 20
_log = logging.getLogger(__name__)


def plugged_causes(answer: Answer) -> list[Cause]:
    """Return the causes among the candidates of other packages."""
    scene = answer.scene
    if scene is None:
        return []
    causes = [cause for plugin in plugins("causes") for cause in _of(plugin, scene, answer)]
    return sorted(causes, key=lambda cause: max(cause.leaves.values()))


def _of(plugin: Plugin, scene: Scene, answer: Answer) -> Iterator[Cause]:
    """Yield the proven causes of one package; an error of its code is a line of the log."""
    elapsed = [Fraction(t) for t in answer.times.tolist()]
    try:
        candidates = plugin.content.candidates(scene, shown(answer))
        for _, changed in zip(range(_MOST), candidates, strict=False):
            exact = ExactMotion(changed, answer.file.c is not None)
            leaves = answer.leaves(exact.at(elapsed, answer.right.has_momenta))
            if leaves and max(leaves.values()) <= LEAVES:
                yield Cause(changed.title, f"{plugin.name} {plugin.origin}", leaves)
    except Exception as error:  # other people's code
        reason = f"{type(error).__name__}: {error}"
        _log.warning(
            "taylor-verify: warning: the cause %s %s: %s", plugin.name, plugin.origin, reason
        )


def shown(answer: Answer) -> dict[str, Any]:
    """Return the rows of an answer by name: t, omega or both impulses or velocities, quaternion, centre."""
    rows = {name: answer.file.v[:, part] for name, part in answer.groups.items()}
    others = {"quaternion": answer.file.q, "centre": answer.file.c}
    return {"t": answer.times, **rows, **{n: r for n, r in others.items() if r is not None}}
