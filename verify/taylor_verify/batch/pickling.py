"""Work that is sent to other processes: by pickle, or by cloudpickle where that is installed.

cloudpickle also sends a lambda, and a function that was written in a notebook or at a prompt.
"""

from __future__ import annotations

import pickle
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Final

_SCRIPT: Final = b"__main__"


def dumps(work: Any) -> bytes:
    """Return work as bytes. Raises ValueError for a function that other processes cannot import."""
    try:
        content = pickle.dumps(work)
    except Exception as error:
        if not _has_cloudpickle():
            mend = "write it at the top of a module, or install cloudpickle"
            raise _refusal(error, mend) from None
    else:
        if _SCRIPT not in content or not _has_cloudpickle():
            return content
    cloudpickle: Any = import_module("cloudpickle")
    try:
        return bytes(cloudpickle.dumps(work))
    except Exception as error:
        mend = "make its locks, files and connections inside it"
        raise _refusal(error, mend) from None


def _refusal(error: Exception, mend: str) -> ValueError:
    expected = f"a solver that can be sent to other processes ({mend})"
    return ValueError(f"expected {expected}, got: {error} @ solver")


def needs_script(content: bytes) -> bool:
    """Return True if a process must import the script of its parent to read these bytes."""
    return _SCRIPT in content and not _has_cloudpickle()


def _has_cloudpickle() -> bool:
    return find_spec("cloudpickle") is not None
