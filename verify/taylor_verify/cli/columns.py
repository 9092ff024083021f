"""The columns of a trajectory file on the command line: what they are, and the option that names others."""

from __future__ import annotations

import argparse
from typing import Final

FILE: Final = (
    "columns t and any of w1 w2 w3 (angular velocity, body axes); u1 u2 u3 (velocity of the body's origin, "
    "body axes; with w it stands for the impulses); x1 x2 x3 y1 y2 y3 (impulses, body axes); q0 q1 q2 q3 "
    "(scalar first, body to space) or r11 ... r33; c1 c2 c3 (centre, space axes). Usual other names (time, "
    "wx, omega_x, qw, p q r) and units such as [ms] or [deg/s] are taken and said; all other columns are "
    "ignored, and named"
)


def add_option(verb: argparse.ArgumentParser) -> None:
    """Add ``--columns`` to a verb that reads a trajectory file."""
    verb.add_argument(
        "--columns",
        action="append",
        metavar="NAME=THEIRS,...",
        help="the file's column for a name above, or for a group (omega=gyro); a comma belongs to THEIRS "
        "unless NAME= follows it; may be repeated: --columns 't=Time [ms],w1=rate, axis 1'",
    )
