"""The verb `list`: everything that has a name."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import Final

from taylor_verify.cli.answer import PASS, Answer
from taylor_verify.cli.arguments import OWN_VERBS
from taylor_verify.cli.console import Page, bold
from taylor_verify.cli.verbs import KIND as VERBS
from taylor_verify.cli.verbs import verbs
from taylor_verify.records.faults import Refused
from taylor_verify.records.plugins import KINDS, Plugin, plugins, say_once
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.schema import schema, text
from taylor_verify.scenes.families.shipped import family, family_names
from taylor_verify.scenes.library import ENGINES, EXTREMES, GUIDE, WORST, added_names, names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.formats.reading import FORMATS, plugged
from taylor_verify.solvers.registry import remarks, solver_names

# The widest name that has its sentence beside it.
_WIDEST: Final = 40


def answer(options: argparse.Namespace) -> Answer:
    """Name the scenes, solvers, rungs and formats of files, each with a sentence; or print the schema."""
    if options.schema:
        return Answer(PASS, schema(), text)
    scenes = {
        "scenes": list(names()),
        "extremes": list(names(EXTREMES, WORST)),
        "engines": list(names(ENGINES)),
    }
    if added := list(added_names()):
        scenes["added"] = added
    every = chain.from_iterable(scenes.values())
    titles = dict(chain.from_iterable(map(_title, every)))
    scenes = {kind: [name for name in group if name in titles] for kind, group in scenes.items()}
    families = {name: family(name).title for name in family_names()}
    formats = {suffix: form.sentence for suffix, form in FORMATS.items()}
    formats |= {suffix: f"{plugin.name} {plugin.origin}" for suffix, plugin in plugged().items()}
    added_by_kind = {kind: _added(kind) for kind in KINDS}
    packages = {kind: {p.name: p.package for p in each} for kind, each in added_by_kind.items()}
    names_by_group = {
        **scenes,
        "families": list(families),
        "solvers": list(solver_names()),
        "rungs": list(LADDER),
        "formats": list(formats),
    }
    origins = {f"{p.name} ({kind})": p.origin for kind in KINDS for p in added_by_kind[kind]}
    sentences = {**titles, **families, **remarks(), **formats, **origins}
    shown = partial(_text, {**names_by_group, "plug-ins": list(origins)}, sentences, GUIDE)
    document = {**names_by_group, "guide": dict(GUIDE), "plugins": packages}
    return Answer(PASS, document, shown)


def _title(name: str) -> Iterator[tuple[str, str]]:
    """Yield a scene's name with its title; one of a plug-in that cannot be read is named on stderr."""
    try:
        yield name, load(name).title
    except Refused as refusal:
        if name not in added_names():
            raise
        say_once(f"{name} is left out: {refusal}")


def _added(kind: str) -> list[Plugin]:
    """Return the plug-ins of a kind without verbs whose names are ours: each is named on stderr."""
    if kind != VERBS:
        return list(plugins(kind))
    left = {verb.name for verb in verbs(OWN_VERBS)}
    return [plugin for plugin in plugins(kind) if plugin.name in left]


def _text(
    names_by_group: Mapping[str, Sequence[str]], titles: Mapping[str, str], guide: Mapping[str, str]
) -> str:
    """Return everything that has a name; a guide to the scenes comes first."""
    page = Page()
    page.line(bold("which scene tells what"))
    guide_width = max(map(len, guide), default=0)
    for name, purpose in guide.items():
        page.line(f"  {name:{guide_width}}  {purpose}")
    for heading, entries in names_by_group.items():
        page.line(bold(heading))
        width = max((len(entry) for entry in entries if len(entry) <= _WIDEST), default=_WIDEST)
        for entry in entries:
            # A long name, as those of solvers with options, has its sentence below.
            if len(entry) > width:
                page.line(f"  {entry}")
            shown = entry if len(entry) <= width else ""
            page.line(f"  {shown:{width}}  {titles.get(entry, '')}".rstrip())
    return page.text()
