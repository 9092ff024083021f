"""Threads that ask for exact numbers at different precisions: each gets its own digits."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

from taylor_verify import exact

DIGITS = (20, 60, 25, 50) * 3


def test_threads_have_their_own_digits() -> None:
    """The working precision of a process serves one call at a time, whatever the others ask for."""
    alone = {digits: exact("euler/generic", ["1/2"], digits) for digits in {*DIGITS}}
    with ThreadPoolExecutor(4) as pool:
        motions = list(pool.map(lambda digits: exact("euler/generic", ["1/2"], digits), DIGITS))
    for digits, motion in zip(DIGITS, motions, strict=True):
        assert (motion["omega"] == alone[digits]["omega"]).all()
        assert max(motion.radius) <= 10.0**-digits
