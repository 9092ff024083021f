"""Files of a planar motion of a solid in a fluid: surge, sway and yaw rate alone, all else being zero."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.formats.column import Column

_VELOCITIES: Final = ("u", "v", "r")
# Names of a planar file, and those of the components that are zero in it.
_ZEROS: Final = (
    (_VELOCITIES, ("w", "p", "q")),
    (("x", "y"), ("z",)),
    (("psi",), ("phi", "theta")),
    (("yaw",), ("roll", "pitch")),
)


def with_zeros(
    columns: Sequence[Column], scene: Scene | None
) -> tuple[list[Column], tuple[str, ...]]:
    """Return the columns with those that are zero in a planar motion behind them, and a note on these."""
    # A name may have a unit behind it, in brackets.
    bare = (column.name.partition("[")[0].partition("(")[0].strip() for column in columns)
    by_name = dict(zip(bare, columns, strict=True))
    named = by_name.keys()
    is_planar = named >= set(_VELOCITIES) and named.isdisjoint(_ZEROS[0][1])
    if scene is None or scene.model != "kirchhoff" or not is_planar:
        return list(columns), ()
    added = [
        zero
        for names, zeros in _ZEROS
        for zero in zeros
        if named >= set(names) and named.isdisjoint(zeros)
    ]
    noughts = ["0"] * len(by_name["u"].values)
    note = f"a planar motion: {' '.join(added)} are not in the file, and are taken as 0"
    return [*columns, *(Column(name, noughts) for name in added)], (note,)
