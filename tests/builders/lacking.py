"""Python processes that lack packages, or what Unix has and other systems do not."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

# Python itself imports this file when it starts, in the processes that it starts too.
_SITE = """
import sys
# To import one of them raises ModuleNotFoundError, as if it were not installed.
sys.modules.update(dict.fromkeys({packages!r}))
"""

# What is in a Python for Unix alone, by the module that has it. Taken away once the libraries are loaded:
# the standard library asks for the system, and would miss what is missing here.
_OF_UNIX = {
    "os": (
        *("fork", "forkpty", "geteuid", "getuid", "getgid", "getpgid", "killpg", "mkfifo", "mknod"),
        *(
            "posix_spawn",
            "posix_spawnp",
            "pread",
            "sched_getaffinity",
            "setsid",
            "setpgid",
            "uname",
        ),
        *("O_NONBLOCK", "O_CLOEXEC", "O_NOFOLLOW", "O_DIRECTORY", "WNOHANG", "fchmod", "chown"),
    ),
    "signal": (
        *("SIGALRM", "SIGCHLD", "SIGHUP", "SIGKILL", "SIGPIPE", "SIGQUIT", "SIGUSR1", "SIGXFSZ"),
        *("ITIMER_REAL", "alarm", "pthread_sigmask", "setitimer", "sigwait"),
    ),
}
_MODULES_OF_UNIX = ("fcntl", "grp", "posix", "pty", "pwd", "resource", "syslog", "termios", "tty")
WITHOUT_UNIX = f"""
import asyncio, ctypes, flint, gmpy2, importlib, json, logging, mpmath, multiprocessing, numpy, pathlib
import platformdirs, rich.console, rich.table, selectors, shutil, socket, subprocess, sys, tempfile
import concurrent.futures.process, inspect
for module, names in {_OF_UNIX!r}.items():
    for name in names:
        vars(importlib.import_module(module)).pop(name, None)
sys.modules.update(dict.fromkeys({_MODULES_OF_UNIX!r}))
"""


def lacking(
    folder: Path, packages: Sequence[str], *arguments: str
) -> subprocess.CompletedProcess[str]:
    """Run this Python with these arguments in a folder, as if the packages were not installed."""
    site = folder / "site"
    site.mkdir(exist_ok=True)
    (site / "sitecustomize.py").write_text(_SITE.format(packages=tuple(packages)))
    path = os.pathsep.join(filter(None, [str(site), *sys.path]))
    environment = {**os.environ, "PYTHONPATH": path}
    command = [sys.executable, *arguments]
    return subprocess.run(
        command, cwd=folder, env=environment, check=False, capture_output=True, text=True
    )
