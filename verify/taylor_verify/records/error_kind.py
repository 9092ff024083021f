"""The kind of an answer's error: a word for programs, in place of a sentence."""

from __future__ import annotations

from enum import StrEnum


class ErrorKind(StrEnum):
    """The main component of the error of a quantity, as far as its samples and its file show."""

    # Not larger than the roundings of the rung explain, at every sample.
    ROUNDOFF = "roundoff"
    # Not larger than the rounding to the printed digits of the file, or to float32.
    PRINTED = "printed digits"
    SINGLE = "float32 storage"
    # The correct motion, but late or early: by a constant, by a slow or fast clock, or irregularly.
    TIME_SHIFT = "time shift"
    PHASE_DRIFT = "drift of phase"
    PHASE_WANDER = "wandering phase"
    # A convention of the file that differs from the scene's explains the error.
    CONVENTION = "convention"
    # About the same at every sample, the first one included.
    OFFSET = "constant size"
    # About as large in every quarter of the time.
    BOUNDED = "bounded"
    # Growing with a power of time, which is the exponent of the verdict.
    GROWTH = "growth"
    NOT_FINITE = "not finite"
    UNEXPLAINED = "unexplained"
