"""Compiled integrators on disk: with the user's other caches, one folder per processor type.

heyoka has a disk cache of its own, which is switched off. Its database has no checksum: a damaged one
raises, or ends the process by a signal. Its key does not name the processor, so that a cache carried
to another machine could run instructions that the processor does not have.

Here an integrator is a file: the SHA-256 of the rest, then heyoka's own serialisation of the
integrator, machine code included. A file is whole or absent, since it is moved into its place, so any
number of processes may share a folder. A file is read only if nobody but its reader could write it:
diskcache and joblib load what anybody has put there.
"""

from __future__ import annotations

import hashlib
import logging
import os
import pickle
import platform
import stat
import tempfile
from collections.abc import Callable
from contextlib import suppress
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, Final

import numpy as np
from platformdirs import user_cache_path

from taylor_verify.numbers.decimal_point import decimal_point

CACHE_VARIABLE: Final = "HEYOKA_CACHE_DIR"
# In bytes. The standard set fills a third of it; the least recently used files go first.
_LARGEST_CACHE: Final = 2**28
_DIGEST_SIZE: Final = hashlib.sha256().digest_size
_log = logging.getLogger(__name__)


@decimal_point()
def stored(make: Callable[..., Any], system: Any, **options: Any) -> Any:
    """Return ``make(system, **options)``, from the disk where an earlier process has stored it.

    Arrays among the options are starting values: they have no part in the compiled code.
    """
    heyoka_cache_off()
    file = cache_folder() / _name(make, system, options)
    integrator = _read(file)
    if integrator is None:
        integrator = make(system, **options)
        _write(file, integrator)
    return integrator


@decimal_point()
def heyoka_cache_off() -> None:
    """Switch heyoka's own disk cache off, and its warnings, which it prints on stdout."""
    import heyoka as hy

    hy.set_logger_level_error()
    hy.llvm_state.set_diskcache_enabled(False)


def cache_folder() -> Path:
    """Return the folder of this processor type, in the cache of the user or that of HEYOKA_CACHE_DIR."""
    base = os.environ.get(CACHE_VARIABLE)
    parent = Path(base) if base else user_cache_path("taylor-verify") / "heyoka"
    return parent / processor_key()


@lru_cache(maxsize=1)
def processor_key() -> str:
    """Return a name that differs between processors with different instruction sets."""
    features = _processor_features()
    digest = hashlib.sha256(features.encode()).hexdigest()[:12]
    return f"{platform.machine() or 'unknown'}-{digest}"


def _processor_features() -> str:
    """Return model and instruction-set flags as Linux lists them; elsewhere what the platform names."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return f"{platform.processor()} {platform.platform()}"
    wanted = ("model name", "cpu family", "model\t", "flags", "Features", "CPU part")
    return "\n".join(sorted({line for line in lines if line.startswith(wanted)}))


def _name(make: Callable[..., Any], system: Any, options: dict[str, Any]) -> str:
    """Return a file name that differs wherever the compiled code could."""
    described = {name: _described(value) for name, value in options.items()}
    asked = pickle.dumps((make.__name__, system, sorted(described.items())))
    return hashlib.sha256(_build() + asked).hexdigest()


def _described(value: Any) -> Any:
    """Return the part of an option that the code depends on, so that equal options are equal bytes.

    Of an array that is its shape. An MPFR number is its precision and its digits: the bytes of a zero
    contain an unset significand, another one in each process.
    """
    import heyoka as hy

    if isinstance(value, np.ndarray):
        return value.shape
    return (value.prec, str(value)) if isinstance(value, hy.real) else value


@lru_cache(maxsize=1)
def _build() -> bytes:
    """Return a text for this installation of heyoka: another build of one version may link otherwise."""
    import heyoka as hy

    installed = os.stat(hy.__file__)
    python = platform.python_version()
    # Code of earlier versions may have been compiled with decimal commas.
    return f"{hy.__version__} decimal point {installed.st_mtime_ns} {installed.st_size} {python}".encode()


def _read(file: Path) -> Any:
    """Return the integrator in a file; None where there is none, or none that can be trusted."""
    try:
        content = _own_bytes(file)
    except OSError:
        return None
    if content is None:
        return None
    digest, data = content[:_DIGEST_SIZE], content[_DIGEST_SIZE:]
    if digest != hashlib.sha256(data).digest():
        _warn_of_damage(file.parent)
        return None
    try:
        integrator = pickle.loads(data)
    except Exception as error:  # whole, but of a library that has changed: it is made anew
        _log.debug("%s cannot be loaded: %s", file, error)
        return None
    with suppress(OSError):
        # The files in use are the youngest, whatever filesystem keeps no times of access.
        os.utime(file)
    return integrator


def _own_bytes(file: Path) -> bytes | None:
    """Return the content of a plain file that this user alone could write; None of any other file."""
    # Without waiting: what lies here could be a pipe.
    handle = os.open(file, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
    with open(handle, "rb") as opened:
        about = os.fstat(handle)
        is_own = not hasattr(os, "geteuid") or about.st_uid == os.geteuid()
        is_closed = not about.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
        return opened.read() if stat.S_ISREG(about.st_mode) and is_own and is_closed else None


@cache
def _warn_of_damage(folder: Path) -> None:
    _log.warning("taylor-verify: warning: damaged compiled code is compiled anew @ %s", folder)


def _write(file: Path, integrator: Any) -> None:
    """Store an integrator for other processes; where nothing can be written, nothing is stored."""
    data = pickle.dumps(integrator, protocol=pickle.HIGHEST_PROTOCOL)
    try:
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=file.parent)
        try:
            with open(handle, "wb") as opened:
                opened.write(hashlib.sha256(data).digest() + data)
            os.replace(name, file)
        except BaseException:
            os.unlink(name)
            raise
        _prune(file.parent)
    except OSError as error:
        _log.debug("nothing is stored in %s: %s", file.parent, error)


def _prune(folder: Path) -> None:
    """Remove the least recently used files beyond the size that a cache may have."""
    files = []
    for entry in os.scandir(folder):
        # Another process may remove it at the same moment.
        with suppress(FileNotFoundError):
            about = entry.stat()
            files.append((about.st_mtime_ns, about.st_size, entry.path))
    size = sum(length for _, length, _ in files)
    for _, length, path in sorted(files):
        if size <= _LARGEST_CACHE:
            return
        with suppress(FileNotFoundError):
            os.unlink(path)
        size -= length
