"""Documents of many shipped scenes, made on all cores."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from taylor_verify.batch.failure import Failed, failing
from taylor_verify.batch.runs import run_all

if TYPE_CHECKING:
    from taylor_verify.scenes.scene import Scene

Document = dict[str, Any]


def documents(
    make: Callable[[Scene], Document], names: Sequence[str], finished: Callable[[str], None]
) -> list[Document]:
    """Return ``make(scene)`` for many scenes, in the order given.

    ``finished`` is called with the name of each scene as it ends. Raises Failed for one that came to
    nothing.
    """
    work = partial(document, make)
    return run_all(work, names, ended=lambda name, _: finished(name), raises=Failed)


def document(make: Callable[[Scene], Document], name: str) -> Document:
    """Return ``make(scene)`` for one scene. Raises Failed with its name."""
    from taylor_verify.exact.solution import Unsettled
    from taylor_verify.scenes.reading.reader import load

    with failing(name, Unsettled):
        return make(load(name))
