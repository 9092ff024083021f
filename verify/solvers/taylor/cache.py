"""Where heyoka keeps compiled code: with the user's other caches, one folder per processor type.

heyoka's key for compiled code does not name the processor, so a cache carried to another machine
(a home directory on a network, a CI cache, a container layer) could run instructions that the
processor does not have. The folder's name does.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import platform
import tempfile
from collections.abc import Iterator
from pathlib import Path

import heyoka as hy
from platformdirs import user_cache_path

_SQLITE = b"SQLite format 3\0"
# In bytes. The standard set fills a quarter of it; what a process pays to open it grows with its size.
_LARGEST_CACHE = 2**28


def use_own_cache() -> None:
    """Point heyoka's disk cache at this processor's folder, or run uncached where none can be made.

    HEYOKA_CACHE_DIR, where set, is the folder in which the processor's own is made.
    """
    # heyoka prints its warnings on stdout, which belongs to the command's own output.
    hy.set_logger_level_error()
    base = os.environ.get("HEYOKA_CACHE_DIR")
    parent = Path(base) if base else user_cache_path("taylor-verify") / "heyoka"
    folder = parent / processor_key()
    # Not said twice: heyoka reads the whole database whenever it is told where it lies.
    if hy.llvm_state.get_diskcache_enabled() and hy.llvm_state.get_diskcache_path() == folder:
        return
    if _is_writable(folder):
        _remove_if_broken(folder / "cache.db")
        hy.llvm_state.set_diskcache_path(str(folder))
        hy.llvm_state.set_diskcache_limit(_LARGEST_CACHE)
    else:
        hy.llvm_state.set_diskcache_enabled(False)


@contextlib.contextmanager
def unstored() -> Iterator[None]:
    """Inside, heyoka stores nothing.

    For MPFR numbers: their compiled code is stored under a key that depends on where the process has
    its memory, so that it is never found again, and the database would grow with every run.
    """
    enabled = hy.llvm_state.get_diskcache_enabled()
    hy.llvm_state.set_diskcache_enabled(False)
    try:
        yield
    finally:
        hy.llvm_state.set_diskcache_enabled(enabled)


def processor_key() -> str:
    """A name that differs between processors with different instruction sets."""
    features = _processor_features()
    digest = hashlib.sha256(features.encode()).hexdigest()[:12]
    return f"{platform.machine() or 'unknown'}-{digest}"


def _processor_features() -> str:
    """Model and instruction-set flags as Linux lists them; elsewhere what the platform names."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return f"{platform.processor()} {platform.platform()}"
    wanted = ("model name", "cpu family", "model\t", "flags", "Features", "CPU part")
    return "\n".join(sorted({line for line in lines if line.startswith(wanted)}))


def _remove_if_broken(database: Path) -> None:
    """heyoka leaves a file that is no database where it is, and compiles everything anew for ever."""
    with contextlib.suppress(OSError):
        with database.open("rb") as file:
            header = file.read(len(_SQLITE))
        if header and header != _SQLITE:
            database.unlink()


def _is_writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
