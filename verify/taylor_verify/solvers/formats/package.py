"""The refusal of a file whose format needs a package that is not installed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from taylor_verify.scenes.faults import Refused


@contextmanager
def needed(package: str, what: str, extra: str, place: object) -> Iterator[None]:
    """Refuse the file at ``place`` if an import in the block lacks the package.

    ``what`` names the format, ``extra`` the optional dependency that installs the package.
    """
    try:
        yield
    except ModuleNotFoundError:
        raise Refused(
            [
                f"expected the package {package} to read {what}, got none @ {place} "
                f"(install it with `pip install 'taylor-verify[{extra}]'`, or write CSV)"
            ]
        ) from None
