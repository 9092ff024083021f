"""Traps of the compiled code that heyoka stores on disk."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import heyoka as hy
from real_is_never_found import PROGRAM as _IN_MPFR

from traps.document import TrapCase
from traps.trap import Cause, Trap


def stored_key(database: Path) -> str:
    """Return the key that is stored beside each piece of code."""
    connection = sqlite3.connect(database)
    try:
        ((key,),) = connection.execute("SELECT DISTINCT env_fingerprint FROM cache")
    finally:
        connection.close()
    return str(key)


def cache_key() -> str:
    """Return the part of the key in the disk cache that describes the environment of compiling."""
    before = hy.llvm_state.get_diskcache_path()
    enabled = hy.llvm_state.get_diskcache_enabled()
    with TemporaryDirectory() as folder:
        hy.llvm_state.set_diskcache_enabled(True)
        hy.llvm_state.set_diskcache_path(folder)
        try:
            hy.llvm_state.clear_memcache()
            hy.taylor_adaptive([(hy.make_vars("x"), hy.expression(0.25))], [0.0])
            return stored_key(Path(folder, "cache.db"))
        finally:
            hy.llvm_state.set_diskcache_enabled(enabled)
            hy.llvm_state.set_diskcache_path(before)


def stored_by(processes: int) -> int:
    """Return the number of pieces of code that processes store, each compiling one system in MPFR."""
    with TemporaryDirectory() as folder:
        for _ in range(processes):
            subprocess.run([sys.executable, "-c", _IN_MPFR, folder], check=True)
        connection = sqlite3.connect(Path(folder, "cache.db"))
        try:
            ((count,),) = connection.execute("SELECT count(*) FROM cache")
        finally:
            connection.close()
    return int(count)


def _stored_code() -> list[TrapCase]:
    driver = "one folder for each type of processor"
    return [TrapCase("what compiled code is stored under", cache_key(), None, driver)]


def _never_found() -> list[TrapCase]:
    count = f"{stored_by(processes=3)} pieces of code on disk"
    return [TrapCase("one system in MPFR, compiled by three processes", count, None, "none")]


STORED_CODE: Final = (
    Trap(
        "S12",
        "stored code does not know its processor",
        (stored_key,),
        _stored_code,
        "stores compiled code under a key in which no processor occurs; that code carried to "
        "another type of processor may not run there is inferred, not reproduced",
        "keeps a folder for each type of processor",
        Cause.PARTLY,
        documented="Network file systems (e.g., NFS, SMB/CIFS) are not supported",
        where="notebooks/jit_caching.html",
        remark="Nothing is said of processors.",
    ),
    Trap(
        "S14",
        "stored code for MPFR numbers is never found again",
        (stored_by,),
        _never_found,
        "compiles one system in several processes with the cache on disk; each stores it anew, under a "
        "key that the unset significand of a zero enters, and whoever next opens the cache reads all of it",
        "stores code itself, under a name made of the equations and options and not of the code",
        Cause.FAULT,
        script="real_is_never_found",
    ),
)
