"""The package heyoka: a check that it can be imported, and the command that installs it.

It is an extra, and it is imported inside functions: only its own integrator needs it.
"""

from __future__ import annotations

from typing import Final

from taylor_verify.numbers.decimal_point import decimal_point
from taylor_verify.solvers.solver import Lack
from taylor_verify.solvers.trajectory import Outcome

NAME: Final = "heyoka"
INSTALL: Final = (
    "pip install 'taylor-verify[taylor]' (macOS, Windows: conda install -c conda-forge heyoka.py)"
)


@decimal_point()
def lack() -> Lack | None:
    """Return the reason why heyoka cannot be imported, with the command that installs it."""
    try:
        import heyoka
    except ImportError as error:
        return Lack(sentence(error), Outcome.NO_PACKAGE)
    del heyoka
    return None


@decimal_point()
def heyoka_cache_off() -> None:
    """Switch heyoka's own disk cache off, and its warnings, which it prints on stdout.

    Its database has no checksum: a damaged one raises, or ends the process by a signal.
    """
    import heyoka as hy

    hy.set_logger_level_error()
    hy.llvm_state.set_diskcache_enabled(False)


def sentence(error: ImportError) -> str:
    """Return the message for an import of heyoka that failed with this error."""
    is_absent = isinstance(error, ModuleNotFoundError) and error.name == NAME
    got = "no such package" if is_absent else f"one that cannot be imported ({error})"
    return f"expected {NAME}, got {got}: {INSTALL}"
