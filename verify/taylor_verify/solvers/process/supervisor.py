"""Run one program, and end all its descendants: `python supervisor.py LINK COMMAND...`.

The program has the standard streams of this process. LINK is a socket to the caller, who is told

    started PID                 it begins, in a session of its own
    refused REASON              the program could not be started
    ended STATUS SECONDS LEFT   its exit status or minus a signal, and the processes that are left

The program is ended early when the caller closes the socket, and so when the caller dies. LEFT are
process numbers, comma between; `none`; or `unknown` where processes that left the session are lost.

On Linux this process adopts the orphans among its descendants, so that none of them can hide: a child
that has left the session and lost its parent is a child of this process. They are all ended, and that
none is left is what the kernel says. Little is imported: every run of a program waits for it.
"""

from __future__ import annotations

import os
import select
import signal
import sys
from contextlib import suppress
from time import monotonic

_PR_SET_CHILD_SUBREAPER = 36
# Seconds for processes that do not end: those of another user, and those held in a system call.
_PATIENCE = 5.0
_GLANCE = 0.02
_IGNORED = [getattr(signal, n) for n in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, n)]
_CHANGED = ("SIGCHLD", "SIGPIPE", "SIGXFSZ", "SIGXFZ")
_OF_PYTHON = [getattr(signal, n) for n in _CHANGED if hasattr(signal, n)]


def main(link: int, command: list[str]) -> None:
    os.set_inheritable(link, False)
    adopts = _adopt_orphans()
    for number in _IGNORED:
        # The caller decides when it is over, and not a key that is pressed.
        signal.signal(number, signal.SIG_IGN)
    deaths = _deaths()
    began = monotonic()
    program = os.fork()
    if not program:
        _become(command, link)
    _let_go_of_streams()
    status = _status(program, link, deaths)
    seconds = monotonic() - began
    left = _end_descendants(deaths) if adopts else _end_session(program)
    _tell(link, f"ended {status} {seconds!r} {left}")


def _adopt_orphans() -> bool:
    """Ask the kernel for all orphans among the descendants; False where no kernel does that."""
    if sys.platform != "linux":
        return False
    try:
        import ctypes

        return bool(ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0) == 0)
    except (ImportError, OSError, AttributeError):
        return False


def _deaths() -> int:
    """Return a pipe that can be read from as soon as a child has ended."""
    reading, writing = os.pipe()
    os.set_blocking(reading, False)
    os.set_blocking(writing, False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
    return reading


def _become(command: list[str], link: int) -> None:
    """Become the program, in a new session, with the signals as a shell has them.

    The caller is told before the program runs, so that it knows of a program that ends its supervisor.
    """
    try:
        os.setsid()
        for number in (*_IGNORED, *_OF_PYTHON):
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        _tell(link, f"started {os.getpid()}")
        os.execvp(command[0], command)
    except OSError as error:
        _tell(link, f"refused {error.strerror}")
    finally:
        os._exit(127)


def _let_go_of_streams() -> None:
    """Leave the streams to the program: their ends would not be heard else."""
    nothing = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):
        os.dup2(nothing, stream)


def _status(program: int, link: int, deaths: int) -> int:
    """Wait for the program, which is killed when the caller says so; adopted children are buried."""
    while True:
        ready, _, _ = select.select([link, deaths], [], [])
        if link in ready:
            _kill(program)
            return -signal.SIGKILL
        _drain(deaths)
        if (status := _bury(program)) is not None:
            return status


def _bury(program: int = 0) -> int | None:
    """Reap the children that have ended; the exit status of the program if it is among them.

    Raises ChildProcessError if there is no child at all.
    """
    exit_status = None
    while True:
        try:
            pid, status = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            if exit_status is None:
                raise
            return exit_status
        if not pid:
            return exit_status
        if pid == program:
            exit_status = os.waitstatus_to_exitcode(status)


def _end_descendants(deaths: int) -> str:
    """Kill all there are, again and again, until the kernel says that none is left."""
    deadline = monotonic() + _PATIENCE
    while True:
        try:
            _bury()
        except ChildProcessError:
            return "none"
        alive = _descendants()
        if monotonic() > deadline:
            return ",".join(map(str, alive)) or "unknown"
        for pid in alive:
            _kill(pid)
        select.select([deaths], [], [], _GLANCE)
        _drain(deaths)


def _descendants() -> list[int]:
    """Return the processes below this one, from /proc: the kernel has no other list."""
    children: dict[int, list[int]] = {}
    with suppress(OSError):
        for name in filter(str.isdigit, os.listdir("/proc")):
            if (parent := _parent(name)) is not None:
                children.setdefault(parent, []).append(int(name))
    descendants, last = [], [os.getpid()]
    while last:
        last = [child for parent in last for child in children.get(parent, ())]
        descendants += last
    return descendants


def _parent(pid: str) -> int | None:
    """Return the parent of a process that has not ended; its own name may hold spaces and brackets."""
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            state, parent = file.read().rpartition(b")")[2].split()[:2]
    except (OSError, ValueError):
        return None
    return None if state in (b"Z", b"X") else int(parent)


def _end_session(program: int) -> str:
    """End the session of the program, on a system where orphans go to another process."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(program, signal.SIGKILL)
    with suppress(ChildProcessError):
        os.waitpid(program, 0)
    return "unknown"


def _kill(pid: int) -> None:
    with suppress(ProcessLookupError, PermissionError):
        os.kill(pid, signal.SIGKILL)


def _drain(pipe: int) -> None:
    with suppress(BlockingIOError):
        os.read(pipe, 4096)


def _tell(link: int, line: str) -> None:
    with suppress(OSError):
        os.write(link, f"{line}\n".encode())


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2:])
