"""A solver that is a program of one's own, in any language: `--solver "process:./my_simulator"`.

The program is asked and answers as verify/solvers/protocol.py says. It is stopped, with all the
processes it started, when its time is up or when it says more than any answer needs; whatever it
does, the run ends with an outcome.
"""

from __future__ import annotations

import json
import os
import selectors
import shlex
import signal
import subprocess
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from math import inf
from time import monotonic, perf_counter
from typing import Any, Final, final

from verify.models.problem import Problem
from verify.solvers import protocol
from verify.solvers.solver import Callback, Solver
from verify.solvers.trajectory import Outcome, Trajectory

PREFIX: Final = "process:"
LIMIT_VARIABLE: Final = "TAYLOR_VERIFY_TIME_LIMIT"
# Seconds for one scene: a hundred times what rk4.py takes for any shipped one at a step of 0.02.
DEFAULT_LIMIT: Final = 300.0

# How often a program is looked at that has ended but whose own children hold its output open.
_GLANCE = 0.05
_CHUNK = 2**16
_KEPT_OF_STDERR = 2**13
_LINES_SHOWN, _LINE_SHOWN = 5, 300
# A step of any method is many operations, and no processor does one in a tenth of a nanosecond. To
# claim more steps than that is false, and would widen the bound of the judge.
_STEPS_PER_SECOND = 1e10


@final
@dataclass(frozen=True)
class Process(Solver):
    """The program behind ``process:COMMAND``; COMMAND is split as a shell would, and no shell runs.

    It may take ``time_limit`` seconds for a problem, its start included.
    """

    name: str
    time_limit: float = DEFAULT_LIMIT
    setting: str = ""

    @property
    def command(self) -> list[str]:
        return shlex.split(self.name.removeprefix(PREFIX))

    def solve(self, problem: Problem) -> Trajectory:
        asked = json.dumps(protocol.question(problem)).encode()
        began = perf_counter()
        ended = _converse(self.command, asked, self.time_limit, protocol.longest_answer(problem))
        seconds = perf_counter() - began
        if ended.outcome is not Outcome.FINISHED:
            return Trajectory(ended.outcome, detail=ended.detail(), seconds=seconds)
        try:
            return _trajectory(ended.answer, problem, seconds)
        except protocol.Misanswer as fault:
            outcome, what = Outcome.MISANSWERED, str(fault)
        except protocol.NotFinite as fault:
            outcome, what = Outcome.NON_FINITE, str(fault)
        detail = replace(ended, what=what).detail()
        return Trajectory(outcome, detail=detail, seconds=seconds)


def named(name: str) -> Process:
    """The solver `process:COMMAND`, its time limit from the environment variable if that is set.

    Raises ValueError for a command that is empty or not closed, and for a limit that is no number.
    """
    try:
        command = shlex.split(name.removeprefix(PREFIX))
    except ValueError as error:
        raise ValueError(
            f"expected a command as a shell reads it, got {name!r} ({error})"
        ) from None
    if not command:
        raise ValueError(f"expected a command after {PREFIX}, got none")
    return Process(name, time_limit())


def time_limit() -> float:
    """Seconds for a problem, as the environment variable says; ValueError where it is no number."""
    text = os.environ.get(LIMIT_VARIABLE)
    if text is None or not text.strip():
        return DEFAULT_LIMIT
    with suppress(ValueError):
        if 0 < float(text) < inf:
            return float(text)
    raise ValueError(f"expected a positive number of seconds, got {text!r} @ {LIMIT_VARIABLE}")


def _trajectory(answer: bytes, problem: Problem, waited: float) -> Trajectory:
    """``waited``: the seconds of the whole run, start of the program and both pipes included."""
    found = protocol.read(answer, problem)
    if not found.steps <= _STEPS_PER_SECOND * waited:
        raise protocol.Misanswer(f"{found.steps} steps in {waited:.3g} seconds @ steps")
    seconds = waited if found.seconds is None else found.seconds
    if not seconds + found.compile_seconds <= waited:
        claimed = f"{seconds:.3g} + {found.compile_seconds:.3g}"
        raise protocol.Misanswer(
            f"expected seconds + compile_seconds within the {waited:.3g} that the whole run took, "
            f"got {claimed} @ seconds"
        )
    # The rows are from here on those of any solver of one's own.
    trajectory = Callback(lambda _: found.states).solve(problem)
    return replace(
        trajectory,
        steps=found.steps,
        evaluations=found.evaluations,
        seconds=seconds,
        compile_seconds=found.compile_seconds,
    )


# Running a program that may do anything.


@dataclass(frozen=True)
class _Ended:
    """How a program ended, what it answered, and the last of what it had to say on stderr."""

    outcome: Outcome
    what: str = ""
    answer: bytes = b""
    stderr: bytes = b""

    def detail(self) -> str:
        said = _last_lines(self.stderr)
        return "; ".join(part for part in (self.what, said and f"stderr: {said}") if part)


def _last_lines(stderr: bytes) -> str:
    lines = [line.rstrip() for line in stderr.decode(errors="replace").splitlines()]
    shown = [line[:_LINE_SHOWN] for line in lines if line][-_LINES_SHOWN:]
    # Escape sequences of a stranger are not for our terminal.
    return " / ".join("".join(c if c.isprintable() else " " for c in line) for line in shown)


def _converse(command: Sequence[str], asked: bytes, limit: float, longest: int) -> _Ended:
    """Start a program, ask it, and have its answer or the outcome; it never outlives the call."""
    try:
        # A session of its own, so that all it starts can be ended with it.
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
            bufsize=0,
        )
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        return _Ended(Outcome.NOT_STARTED, f"{command[0]}: {reason}")
    talk = _Talk(process, asked)
    try:
        with _ending_with_us(process):
            outcome, what = talk.listen(monotonic() + limit, longest)
    finally:
        _end(process)
    if outcome is Outcome.TIMED_OUT:
        what = f"{limit:g} seconds, settable by {LIMIT_VARIABLE}"
    elif outcome is Outcome.FINISHED and process.returncode:
        outcome, what = Outcome.CRASHED, _status(process.returncode)
    return _Ended(outcome, what, bytes(talk.answer), bytes(talk.stderr))


class _Talk:
    """The three pipes of a running program; none of them is ever waited for alone."""

    def __init__(self, process: subprocess.Popen[bytes], asked: bytes) -> None:
        self.process = process
        self.unsaid = memoryview(asked)
        self.answer, self.stderr = bytearray(), bytearray()

    def listen(self, deadline: float, longest: int) -> tuple[Outcome, str]:
        """Until the program has ended, or was too long about it or too long in it."""
        process = self.process
        with selectors.DefaultSelector() as waiting:
            self._register(waiting)
            while waiting.get_map():
                left = deadline - monotonic()
                if left <= 0:
                    return Outcome.TIMED_OUT, ""
                ready = waiting.select(min(left, _GLANCE))
                for key, _ in ready:
                    if not key.data():
                        waiting.unregister(key.fileobj)
                        key.fileobj.close()  # type: ignore[union-attr]
                if len(self.answer) > longest:
                    return Outcome.MISANSWERED, f"more than {longest} bytes on standard output"
                if not ready and process.poll() is not None:
                    break
        try:
            process.wait(max(0.0, deadline - monotonic()))
        except subprocess.TimeoutExpired:
            return Outcome.TIMED_OUT, ""
        return Outcome.FINISHED, ""

    def _register(self, waiting: selectors.BaseSelector) -> None:
        for pipe, event, act in (
            (self.process.stdin, selectors.EVENT_WRITE, self._say),
            (self.process.stdout, selectors.EVENT_READ, self._hear),
            (self.process.stderr, selectors.EVENT_READ, self._overhear),
        ):
            assert pipe is not None
            os.set_blocking(pipe.fileno(), False)
            waiting.register(pipe, event, act)

    # Each of these returns whether its pipe is still of use.

    def _say(self) -> bool:
        assert self.process.stdin
        try:
            said = os.write(self.process.stdin.fileno(), self.unsaid[:_CHUNK])
        except BlockingIOError:
            return True
        except OSError:
            # A program may answer without reading to the end.
            return False
        self.unsaid = self.unsaid[said:]
        return bool(self.unsaid)

    def _hear(self) -> bool:
        read = _read(self.process.stdout)
        self.answer += read or b""
        return read != b""

    def _overhear(self) -> bool:
        read = _read(self.process.stderr)
        self.stderr += read or b""
        del self.stderr[:-_KEPT_OF_STDERR]
        return read != b""


def _read(pipe: Any) -> bytes | None:
    """What there is: nothing at the end, None where there is nothing yet."""
    try:
        return os.read(pipe.fileno(), _CHUNK)
    except BlockingIOError:
        return None


def _end(process: subprocess.Popen[bytes]) -> None:
    """Kill what is left of the program and of all it started, and leave no zombie."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    for pipe in (process.stdin, process.stdout, process.stderr):
        if pipe is not None:
            with suppress(OSError):
                pipe.close()


@contextmanager
def _ending_with_us(process: subprocess.Popen[bytes]) -> Iterator[None]:
    """Let a SIGTERM, with which a pool ends its workers, end the program first.

    Nothing else of this process would run any more. A handler that is there already is left alone.
    """
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        yield
        return

    def end_both(number: int, frame: object) -> None:
        del frame
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    signal.signal(signal.SIGTERM, end_both)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _status(returncode: int) -> str:
    if returncode > 0:
        return f"exit status {returncode}"
    try:
        return f"signal {signal.Signals(-returncode).name}"
    except ValueError:
        return f"signal {-returncode}"
