"""Links to the glossary: the first use of each of its words on a page leads to the definition.

The Markdown of a page has no such links, which are added when the site is built. Generated pages and
docstrings get them like pages of docs.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Final

from docutils import nodes
from sphinx import addnodes

if TYPE_CHECKING:
    from sphinx.application import Sphinx

# The linked headings of the glossary, each with a pattern of its forms in sentences.
TERMS: Final = {
    "added mass": r"added mass(?:es)?",
    "attainable": r"attainable",
    "ball": r"balls?",
    "baseline": r"baselines?",
    "Casimir": r"Casimirs?",
    "Clebsch's body": r"Clebsch's body",
    "closed form": r"closed forms?",
    "conditioning": r"conditioning",
    "conserved quantity": r"conserved quantit(?:y|ies)",
    "drift of phase": r"drift of phase",
    "enclosure": r"enclosures?",
    "floor": r"(?:roundoff )?floors?",
    "gyroscopic term": r"gyroscopic term",
    "gyrostat": r"gyrostats?",
    "herpolhode": r"herpolhodes?",
    "manufactured motion": r"manufactured motions?",
    "modulus": r"modulus",
    "Munk moment": r"Munk moment",
    "order of convergence": r"orders? of convergence",
    "polhode": r"polhodes?",
    "regime": r"regimes?",
    "rounding class": r"rounding class(?:es)?",
    "rung": r"rungs?",
    "separatrix": r"separatri(?:x|ces)",
    "standard set": r"standard set",
    "undecided": r"undecided",
    "vacuous": r"vacuous",
    "work-precision diagram": r"work-precision diagrams?",
}
CLASS: Final = "term"
_PAGE: Final = "glossary"
# Words are linked in sentences, but not in headings, code, links, formulas and tables.
_SENTENCES: Final = (nodes.paragraph,)
_WITHOUT_LINKS: Final = (
    nodes.reference,
    nodes.literal,
    nodes.literal_block,
    nodes.math,
    nodes.title,
    nodes.table,
    addnodes.pending_xref,
    addnodes.desc_signature,
    addnodes.download_reference,
    nodes.raw,
)


def link_terms(app: Sphinx, doctree: nodes.document) -> None:
    """Make the first use of each term on a page a link to the glossary."""
    page = app.env.docname
    glossary = next(
        (name for name in app.env.found_docs if PurePosixPath(name).name == _PAGE), None
    )
    if glossary is None or page == glossary:
        return
    place = app.builder.get_relative_uri(page, glossary)
    own = _linked_by_hand(doctree)
    unlinked = {term: _pattern(term) for term in TERMS if nodes.make_id(term) not in own}
    for text in list(_sentences(doctree)):
        parts = list(_linked(text.astext(), place, unlinked))
        if len(parts) > 1:
            text.parent.replace(text, parts)


def _linked_by_hand(doctree: nodes.document) -> set[str]:
    """Return the headings of the glossary to which the page has links of its own."""
    links = (link for link in doctree.findall(addnodes.pending_xref) if "reftarget" in link)
    targets = (link for link in links if PurePosixPath(link["reftarget"]).stem == _PAGE)
    return {link.get("reftargetid") for link in targets}


def _sentences(doctree: nodes.document) -> Iterator[nodes.Text]:
    """Yield the texts of a page in which terms are linked."""
    for text in doctree.findall(nodes.Text):
        parents = list(_parents(text))
        if any(isinstance(p, _SENTENCES) for p in parents) and not any(
            isinstance(p, _WITHOUT_LINKS) for p in parents
        ):
            yield text


def _parents(node: nodes.Node) -> Iterator[nodes.Node]:
    while node.parent is not None:
        node = node.parent
        yield node


def _linked(text: str, place: str, unlinked: dict[str, re.Pattern[str]]) -> Iterator[nodes.Node]:
    """Yield the parts of a text, with links for terms; a linked term is removed from ``unlinked``."""
    while text:
        first = min(
            (
                (match.start(), term, match)
                for term, form in unlinked.items()
                if (match := form.search(text))
            ),
            default=None,
        )
        if first is None:
            yield nodes.Text(text)
            return
        start, term, match = first
        del unlinked[term]
        if start:
            yield nodes.Text(text[:start])
        yield nodes.reference(
            "", match[0], refuri=f"{place}#{nodes.make_id(term)}", internal=True, classes=[CLASS]
        )
        text = text[match.end() :]


@cache
def _pattern(term: str) -> re.Pattern[str]:
    """Return the compiled pattern of a term, which matches whole words only."""
    return re.compile(rf"(?<![\w-]){TERMS[term]}(?![\w-])", re.IGNORECASE)
