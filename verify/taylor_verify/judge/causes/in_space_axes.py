"""A rigid body whose equations are in space axes, with the tensor of body axes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from taylor_verify.judge.causes.basis import coriolis_of
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import may_leave, whole
from taylor_verify.judge.causes.quaternion_rows import matrices


def in_world(answer: Answer, omega: Floats) -> list[Cause]:
    """Return the cause of rows of ``omega``, space axes, of a body whose tensor is not turned with it."""
    world = _in_space_axes(answer, omega)
    none = answer.right.basis.factors(products=-coriolis_of(answer.right.mass))
    name = (
        "the tensor is not turned with the body: its entries for body axes are used in space axes"
    )
    without = f"{name}, and there is no gyroscopic term: omega' = I^-1 R M", {"extra": none}
    # Without a moment no tensor has a part in it.
    for words, changes in (
        *[without] * answer.right.has_loads,
        (f"{name}: I omega' = I omega x omega + R M", {}),
    ):
        if not world.failed or not world.moving:
            return []
        motion = whole(world, world.right.changed(changes))
        leaves = {} if motion is None else world.leaves(motion)
        if leaves and max(leaves.values()) <= may_leave(world, world.moving):
            return [Cause(words, "tensor in space axes", leaves)]
    return []


def _in_space_axes(answer: Answer, omega: Floats) -> Answer:
    """Return a rigid body's answer with omega, and the equations, in space axes."""
    turned, first = map(_with_omega_in_space, (answer.truth, answer.start))
    right = answer.right.changed({"in_world": True, "turns": np.array([1.0, 0.0])})
    file = Motion(omega, answer.file.q)
    return replace(answer, right=right, start=first, truth=turned, file=file)


def _with_omega_in_space(motion: Motion) -> Motion:
    assert motion.q is not None
    return replace(motion, v=np.einsum("nij,nj->ni", matrices(motion.q), motion.v))
