"""The kind of the error that is left in an answer: the word that a program reads in place of a sentence."""

from __future__ import annotations

from enum import StrEnum


class ErrorKind(StrEnum):
    """What the error of a quantity is made of, as far as its samples and its file tell."""

    # Within what arithmetic of the rung would leave, at every sample.
    ROUNDOFF = "roundoff"
    # No larger than what the printed digits of the file leave, or storing in float32.
    PRINTED = "printed digits"
    SINGLE = "float32 storage"
    # The right motion late or early by a constant, by a clock that runs slow or fast, at wandering times.
    TIME_SHIFT = "time shift"
    PHASE_DRIFT = "drift of phase"
    PHASE_WANDER = "wandering phase"
    # The file departs from the scene's conventions, which explains the error.
    CONVENTION = "convention"
    # About the same at every sample, the first one included.
    OFFSET = "constant size"
    # About as large in every quarter of the time.
    BOUNDED = "bounded"
    # Growing with a power of time, which is the exponent of the verdict.
    GROWTH = "growth"
    NOT_FINITE = "not finite"
    UNEXPLAINED = "unexplained"
