"""Contract of a plug-in, for the tests of its author, in an environment where it is installed.

    def test_my_plugins():
        taylor_verify.testing.contract.keeps_contract("my-distribution")

Each plug-in of the distribution is imported and used once, as taylor_verify uses it.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any, Final

from taylor_verify.chain import solve_scene
from taylor_verify.exact import exact
from taylor_verify.records.plugins import KINDS, entries, load, package_of
from taylor_verify.scenes.reading.reader import load as load_scene
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.script import read_script
from taylor_verify.solvers.function import solver_of
from taylor_verify.solvers.trajectory import Outcome

_SCENE: Final = "euler/rest"


class BrokenContract(AssertionError):  # noqa: N818 (it names what happened)
    """A plug-in that breaks its contract; the text says which, and what was expected."""


def keeps_contract(distribution: str) -> list[str]:
    """Use every plug-in of an installed distribution once, and return their kinds and names.

    Raises BrokenContract with the faults of all of them, and where there is no plug-in.
    """
    checked, faults = list[str](), list[str]()
    for kind in KINDS:
        for entry in entries(kind):
            if package_of(entry) != distribution:
                continue
            checked.append(f"{kind} {entry.name}")
            try:
                content = load(kind, entry)
                if use := _USES.get(kind):
                    use(content)
            except Exception as error:
                faults.append(f"{kind} {entry.name}: {error}")
    if not checked:
        faults.append(f"expected plug-ins of {distribution}, got none (is it installed?)")
    if faults:
        raise BrokenContract("\n".join(faults))
    return checked


def check_reader(reader: Any, example: str | PathLike[str]) -> None:
    """Read an example with a reader. Raises BrokenContract where the table has no column of times."""
    table = reader.read(Path(example))
    if "t" not in list(table):
        raise BrokenContract(f"expected a column t, got {', '.join(map(str, table)) or 'none'}")


def _use_solver(content: Any) -> None:
    trajectory = solve_scene(_SCENE, solver_of(content, "a plug-in"))
    if trajectory.outcome is not Outcome.FINISHED and not trajectory.outcome.is_unavailable:
        raise BrokenContract(f"it {trajectory.outcome.value} ({trajectory.detail})")


def _use_scenes(content: Any) -> None:
    for file in sorted(Path(content).glob("*.toml")):
        load_scene(file)


def _use_causes(content: Any) -> None:
    scene = load_scene(_SCENE)
    motion = exact(scene, scene.clock.instants, 20)
    rows = {name: values.astype(float) for name, values in motion.quantities.items()}
    times = [float(time) for time in scene.clock.instants]
    for changed in content.candidates(scene, {"t": times, **rows}):
        if not isinstance(changed, Scene) or changed.title == scene.title:
            raise BrokenContract(
                f"expected changed scenes with titles of their own, got {changed!r:.60}"
            )


_USES: Final[Mapping[str, Callable[[Any], object]]] = {
    "solvers": _use_solver,
    "scenes": _use_scenes,
    "engines": lambda content: read_script(Path(content)),
    "causes": _use_causes,
    "verbs": lambda content: content.add(argparse.ArgumentParser()),
}
