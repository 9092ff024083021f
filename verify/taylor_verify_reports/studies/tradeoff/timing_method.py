"""Method of the published times in words: what is timed, the rounds, the machine, the command."""

from __future__ import annotations

from typing import Final

from taylor_verify.words.cells import figure
from taylor_verify.words.markdown import code, prose, table
from taylor_verify_reports.studies.tradeoff.trades import NUMBERS, TIMINGS, Trades

_WHAT_IS_TIMED: Final = (
    (
        "taylor",
        "heyoka's steps, compiled, and the driver in Python, with its search for the longest step "
        "where none is known",
        "compiling, rounding the scene to the rung, making exact numbers of the answer",
    ),
    (
        "scipy",
        "`solve_ivp` as a whole, with `t_eval`; the equations are straight-line Python on plain "
        "floats, each operation once; LSODA's own steps are compiled Fortran",
        "loading SciPy, making the straight-line code",
    ),
    (
        "geometric",
        "every step, Python throughout, and the attitude where it is tracked",
        "nothing but rounding the scene",
    ),
    ("mpmath", "`odefun` as a whole, Python throughout", "making the straight-line code"),
    (
        "outside",
        "the propagation as a whole, compiled; the process of the library times it by the same clock, "
        "in as many solves",
        "compiling, the way of questions and answers between processes",
    ),
)


def what_is_timed() -> str:
    """Return the parts that a time includes and excludes, solver by solver."""
    columns = ["solver", "in the time", "not in it"]
    return table(columns, [[code(name), inside, apart] for name, inside, apart in _WHAT_IS_TIMED])


def how_it_was_timed(trades: Trades) -> list[str]:
    """Return the method of the measurement with its numbers."""
    m, machine = trades.times.method, trades.times.machine
    return [
        f"{m.processes} fresh processes, one after the other. Hash seeds, places in memory and the "
        "processor's frequency vary between processes, not within one, so the sample is the number of "
        "processes, and not of solves.",
        f"Each process has {m.rounds} rounds. A round has every setting once, in a random order (seed "
        f"{m.seed}). One measurement is as many solves as take {figure(m.least_seconds)} s or "
        f"{m.times_resolution} times the clock's resolution ({figure(m.clock_resolution)} s), "
        "whichever is longer, so that the resolution is below 1 %. Python's collector of garbage is "
        "off. Settings that take more than a fifth of a second are solved once in each process.",
        "Times are processor times, without other programs on the machine. A library of `outside` has "
        "a process of its own that stays, and takes its turn there.",
        f"Each time is divided by that of `{trades.numbers.yardstick}` in the same round. A process "
        "gives the median of its rounds; the table shows the median of the processes.",
        _brackets(trades),
        f"Machine: {prose(machine.processor)}, Python {prose(machine.python)}. Ratios of compiled code "
        "to Python, above all, differ on other machines.",
    ]


def _brackets(trades: Trades) -> str:
    """Return the meaning of the interval in brackets."""
    m = trades.times.method
    n, coverage = m.processes, f"{m.coverage:.1%}"
    formula = (
        f"the k-th smallest and the k-th largest of n do so with probability {prose(m.formula)}, "
        f"k the largest that leaves {m.confidence:.0%}; here n = {n}"
    )
    if not m.coverage >= m.confidence:
        return f"No interval is given: {formula}, where the extremes have no more than {coverage}."
    return (
        f"The brackets enclose the median of the distribution of processes with {coverage}, for any "
        f"distribution: {formula}. They do not apply to another machine."
    )


def remake(trades: Trades) -> str:
    """Return the commands that make the measurement again, and the versions of this one."""
    packages = ", ".join(f"{name} {version}" for name, version in trades.numbers.versions.items())
    return (
        "`make tradeoff`, which is `taylor-verify publish tradeoff --outside`, repeats the measurement. "
        "Without `--outside` the compiled integrators of other libraries are left out. It writes "
        f"[tradeoff.json](../{NUMBERS.name}) (errors, the same on any machine except for rounding) and "
        f"[tradeoff-timings.json](../{TIMINGS.name}) (times of this machine, which no test compares); "
        "this page and its sheet `tradeoff.csv` are made from those alone. `make reports` and `make "
        "check-reports` leave the times as they are. Made by "
        f"{code(trades.times.machine.command)} with {packages or 'unknown versions'}."
    )
