"""Refusals of files that need a missing library, or that a library cannot read."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from taylor_verify.scenes.reading.faults import Refused, cut, refusal


@contextmanager
def needed(package: str, what: str, extra: str, place: object) -> Iterator[None]:
    """Refuse the file at ``place`` if an import in the block lacks the package.

    ``what`` names the format, ``extra`` the optional dependency that installs the package.
    """
    try:
        yield
    except ModuleNotFoundError:
        mend = f"install it with `pip install 'taylor-verify[{extra}]'`, or write CSV"
        raise refusal(f"the package {package} to read {what}", "none", place, mend) from None


@contextmanager
def unbroken(what: str, place: object) -> Iterator[None]:
    """Refuse the file at ``place`` if the block raises anything.

    No library documents which exceptions a broken file becomes.
    """
    try:
        yield
    except Refused:
        raise
    except Exception as error:
        reason = cut((str(error).splitlines() or [type(error).__name__])[0])
        raise refusal(what, f"a fault in it: {reason}", place) from None
