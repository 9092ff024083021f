"""The provenance of a published number: versions, processor, command and scene."""

from __future__ import annotations

import platform
import sys
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from taylor_verify.records.provenance import Machine

PACKAGES = ("taylor-verify", "heyoka", "numpy", "mpmath", "python-flint")


@lru_cache
def versions() -> dict[str, str]:
    by_name = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            by_name[package] = version(package)
        except PackageNotFoundError:
            by_name[package] = "not installed"
    return by_name


@lru_cache
def processor() -> str:
    """Return the processor's name if the system provides it, else its architecture."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def command() -> str:
    return " ".join(["taylor-verify", *sys.argv[1:]])


def packages() -> dict[str, str]:
    """Return the versions of the packages. Python is left out, because no number depends on its version."""
    return {package: number for package, number in versions().items() if package != "python"}


def machine() -> Machine:
    """Return this machine: Python's version, the processor's name, and the command line."""
    return Machine(python=versions()["python"], processor=processor(), command=command())


def provenance(scene_digest: str) -> dict[str, Any]:
    return {
        "versions": versions(),
        "processor": processor(),
        "command": command(),
        "scene": scene_digest,
    }
