"""Documents of many shipped scenes, made on all cores."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from taylor_verify.batch.failure import Failed, failing
from taylor_verify.batch.work import run_all

if TYPE_CHECKING:
    from taylor_verify.scenes.scene import Scene

Document = dict[str, Any]


def documents(
    make: Callable[[Scene], Document],
    names: Sequence[str],
    finished: Callable[[str], None],
    keep: Callable[[Document], object] | None = None,
) -> list[Document]:
    """Return ``make(scene)`` for many scenes, in the order given.

    As each scene ends, ``keep`` is called with its document and ``finished`` with its name. Raises Failed
    for one that came to nothing.
    """

    def ended(name: str, document: Document) -> None:
        if keep is not None:
            keep(document)
        finished(name)

    return run_all(partial(document, make), names, ended=ended, raises=Failed)


def document(make: Callable[[Scene], Document], name: str) -> Document:
    """Return ``make(scene)`` for one scene. Raises Failed with its name."""
    from taylor_verify.exact.solution import Unsettled
    from taylor_verify.scenes.reading.reader import load

    with failing(name, Unsettled):
        return make(load(name))
