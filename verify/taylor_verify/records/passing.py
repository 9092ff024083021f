"""Results that passed or did not: their truth value, and the error that they raise."""

from __future__ import annotations

from abc import abstractmethod


class NotPassed(AssertionError):  # noqa: N818 (it names what the result did)
    """The error for a result that did not pass; its text is that of the result."""


class Passing:
    """A result that passed or did not; its truth value is ``passed``."""

    @property
    @abstractmethod
    def passed(self) -> bool:
        """True if it passed."""

    def __bool__(self) -> bool:
        return self.passed

    def raise_for_failure(self) -> None:
        """Raise NotPassed, an AssertionError with the text of the result, unless it passed."""
        if not self.passed:
            raise NotPassed(str(self))
