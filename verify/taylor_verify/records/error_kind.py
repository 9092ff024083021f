"""The kind of the error that is left in an answer: the word that a program reads in place of a sentence."""

from __future__ import annotations

from enum import StrEnum


class ErrorKind(StrEnum):
    """What the error of a quantity is made of, as far as its samples tell.

    ROUNDOFF        within what arithmetic of the rung would leave, at every sample
    PRINTED         no larger than what the printed digits of the file leave
    SINGLE          no larger than what storing in float32 leaves
    TIME_SHIFT      the right motion, late or early by a constant
    PHASE_DRIFT     the right motion by a clock that runs slow or fast
    PHASE_WANDER    the right motion at times that wander
    CONVENTION      the file departs from the scene's conventions, which explains the error
    OFFSET          about the same at every sample, the first one included
    BOUNDED         as large in the first tenth of the time as ever after
    GROWTH          growing with a power of time, which is ``exponent``
    NOT_FINITE      a sample is no finite number
    UNEXPLAINED     none of these
    """

    ROUNDOFF = "roundoff"
    PRINTED = "printed digits"
    SINGLE = "float32 storage"
    TIME_SHIFT = "time shift"
    PHASE_DRIFT = "drift of phase"
    PHASE_WANDER = "wandering phase"
    CONVENTION = "convention"
    OFFSET = "constant offset"
    BOUNDED = "bounded"
    GROWTH = "growth"
    NOT_FINITE = "not finite"
    UNEXPLAINED = "unexplained"
