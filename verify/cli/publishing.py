"""What `publish` computes or measures anew before it writes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from verify.cli.answer import Answer, WrongCall, files_written
from verify.cli.streams import say


def references(folder: Path) -> Answer:
    """The exact trajectory of every shipped scene."""
    from verify.publish import reference_files
    from verify.reference import references
    from verify.scenes.library import names

    scenes = names()
    documents = references(scenes, _counting(len(scenes)))
    return files_written(reference_files.write(folder, documents))


def controls(folder: Path) -> Answer:
    """What each gate sees of broken solvers, and what heyoka does where nobody takes care."""
    from verify.controls import sight
    from verify.controls.defects import DEFECTS
    from verify.controls.traps import table
    from verify.publish import report, traps

    finished = _counting(len(DEFECTS) + len(table.TRAPS))
    seen = sight.document(sight.sights(DEFECTS, finished))
    trapped = table.document(table.TRAPS, finished)
    return files_written([*report.publish_controls(folder, seen), *traps.publish(folder, trapped)])


def prices(folder: Path) -> Answer:
    """What each thing that a scene may ask for costs, measured."""
    from verify.publish import prices as pages
    from verify.trade.prices import RUNGS, document

    return files_written(pages.write(folder, document(_counting(len(RUNGS)))))


def tradeoff(folder: Path, outside: bool) -> Answer:
    """Speed against accuracy on the published scenes, measured in fresh processes."""
    from verify.publish import report
    from verify.trade.measurement import measurement

    found = measurement(with_outside=outside, finished=say)
    return files_written(report.publish_tradeoff(folder, found.numbers(), found.times()))


def reach(folder: Path) -> Answer:
    """How far each precision carries in every family of extremes."""
    from verify.publish import reach as pages
    from verify.trade.reach import document, members

    return files_written(pages.write(folder, document(_counting(members()))))


def worst(folder: Path, seconds: float, seed: int) -> Answer:
    """The worst error over attainable in each family; its scenes take the place of those kept."""
    from verify.hunt import FAMILIES, document, hunt
    from verify.publish import worst as pages
    from verify.scenes.library import WORST, cases_directory

    if not seconds > 0:
        raise WrongCall(f"expected a time in seconds above 0, got {seconds:g} @ --seconds")
    found = hunt(FAMILIES, seconds, seed, _counting(len(FAMILIES)))
    scenes = {one.family.name: one.scene_text for one in found}
    kept = pages.keep(cases_directory() / WORST, scenes)
    return files_written([*pages.write(folder, document(found, seconds, seed)), *kept])


def _counting(total: int) -> Callable[[str], None]:
    """Tells each name as it ends, with its place among all."""
    ended: list[str] = []

    def finished(name: str) -> None:
        ended.append(name)
        say(f"{len(ended)}/{total} {name}")

    return finished
