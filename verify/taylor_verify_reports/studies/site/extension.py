"""Sphinx extension: formulas as MathML, links of scenes, search without large tables.

It also gives the kernels of notebooks settings of their own, and writes each notebook as a file to
download.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from docutils import nodes
from sphinx import addnodes

from taylor_verify.records.file_names import of_scene
from taylor_verify_reports.studies.site.notebooks import add_link, write_notebooks
from taylor_verify_reports.typesetting.mathml import inline, mathml

if TYPE_CHECKING:
    from sphinx.application import Sphinx

SCENES: Final = "reports/scenes"

# GitHub writes a formula within a line as a code span between dollars, MyST between dollars alone.
_FORMULA: Final = re.compile(r"\$`([^`\n]+)`\$")
_SCENE: Final = re.compile(r"\w+(?:/[\w-]+)+")
# A local kernel needs no encryption, and must not warn that it has none. It needs no history of cells.
_KERNEL: Final = "c.IPKernelApp.log_level = 40\nc.HistoryManager.enabled = False\n"
# Report tables with more rows are lists of numbers, which nobody searches for, and would fill the index.
# The tables of docs have words, and stay in the index.
_SEARCHED_ROWS: Final = 20
_NUMBERS: Final = "reports/"


def setup(app: Sphinx) -> dict[str, Any]:
    """Register everything with Sphinx, and return what Sphinx wants to know of an extension."""
    app.connect("builder-inited", _set_kernels)
    app.connect("source-read", _read_formulas)
    app.connect("doctree-read", _link_scenes)
    app.connect("doctree-read", add_link)
    app.connect("doctree-read", _leave_out_of_search)
    app.connect("build-finished", write_notebooks)
    app.add_html_math_renderer("mathml", (_write_inline, None), (_write_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _set_kernels(app: Sphinx) -> None:
    """Keep kernels from reading the user's settings of IPython, and from writing beside them."""
    folder = Path(app.doctreedir, "ipython")
    settings = folder / "profile_default" / "ipython_kernel_config.py"
    settings.parent.mkdir(parents=True, exist_ok=True)
    settings.write_text(_KERNEL, encoding="utf-8")
    os.environ["IPYTHONDIR"] = str(folder)


def _read_formulas(_app: Sphinx, _page: str, content: list[str]) -> None:
    """Write GitHub's formulas within lines as MyST's."""
    content[0] = _FORMULA.sub(r"$\1$", content[0])


def _link_scenes(app: Sphinx, doctree: nodes.document) -> None:
    """Make each code span that is the name of a scene with a page a link to that page."""
    for span in list(doctree.findall(nodes.literal)):
        text = span.astext()
        page = f"{SCENES}/{of_scene(text)}" if _SCENE.fullmatch(text) else ""
        is_elsewhere = page in app.env.found_docs and page != app.env.docname
        if not is_elsewhere or _is_within_link_or_heading(span):
            continue
        link = addnodes.pending_xref(
            "", refdomain="std", reftype="doc", reftarget=f"/{page}", refexplicit=True, refwarn=True
        )
        span.replace_self(link)
        link += span


def _is_within_link_or_heading(node: nodes.Node | None) -> bool:
    while node is not None:
        if isinstance(node, nodes.reference | nodes.title | addnodes.pending_xref):
            return True
        node = node.parent
    return False


def _leave_out_of_search(app: Sphinx, doctree: nodes.document) -> None:
    """Mark large tables of the report, which the search then skips."""
    if not app.env.docname.startswith(_NUMBERS):
        return
    for table in doctree.findall(nodes.table):
        if len(list(table.findall(nodes.row))) > _SEARCHED_ROWS:
            table["classes"].append("no-search")


def _write_inline(writer: Any, node: nodes.math) -> None:
    writer.body.append(inline(node.astext()))
    raise nodes.SkipNode


def _write_block(writer: Any, node: nodes.math_block) -> None:
    writer.body.append(f'<div class="formula">{mathml(node.astext(), display=True)}</div>\n')
    raise nodes.SkipNode
