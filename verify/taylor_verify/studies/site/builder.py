"""The whole site: every page, the files that pages link to, and the scripts, made anew each time."""

from __future__ import annotations

import io
import json
import re
import tarfile
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from taylor_verify.records.file_names import of_scene
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.studies.site.drawing import smaller
from taylor_verify.studies.site.links import PACKED, Links
from taylor_verify.studies.site.looks import Palette
from taylor_verify.studies.site.pages import NAVIGATION, Page, pages
from taylor_verify.studies.site.prose import Prose
from taylor_verify.studies.site.source import Report

MADE_BY: Final = "<!-- made by taylor-verify publish --site; do not edit -->"
FRONT: Final = "index.html"

_HERE: Final = Path(__file__).parent
_SCRIPT: Final = "plotly.min.js"
# The Markdown that has a page; the gates have one that is made of the verdicts instead.
_INDEX: Final = {"README.md": FRONT, "tables/gates.md": "tables/gates.html"}


def build(folder: Path | str, target: Path | str) -> list[Path]:
    """Make the site of the report in ``folder`` in place of an earlier one in ``target``.

    Returns the files written. Raises ImportError without jinja2, markdown-it-py, latex2mathml or
    plotly, OSError for files that cannot be read or written, and ValueError for data that are none
    and for a target that holds something else.
    """
    source, place = Path(folder), Path(target)
    stale = _earlier(place)
    return list(replace_files(place, contents(source), stale=stale))


def contents(folder: Path) -> dict[str, str | bytes]:
    """Every file of the site by its place in it. The errors are those of `build`."""
    report, palette = Report(folder), Palette()
    links = Links(folder, _markdown_pages(folder), _scene_pages(report))
    templates = _templates()
    found: dict[str, str | bytes] = {}
    for page in pages(report, Prose(links), links, palette):
        found[page.place] = _rendered(templates, page, report)
    found |= dict(_assets(palette))
    for name, files in links.files.items():
        found[name] = _packed(files) if name.endswith(PACKED) else _shown(*files)
    return found


def _rendered(templates: Environment, page: Page, report: Report) -> str:
    root = "../" * page.place.count("/")
    shared = {"root": root, "navigation": NAVIGATION, "footer": _footer(report)}
    text = templates.get_template(page.template).render(
        {**shared, "section": page.section, **page.context}
    )
    return text.rstrip() + "\n"


def _footer(report: Report) -> str:
    """What the numbers were made with and where."""
    packages = ", ".join(f"{name} {version}" for name, version in report.versions.items())
    machines = "; ".join(
        f"{machine.get('processor', 'an unnamed processor')}, `{machine.get('command', '')}`"
        for machine in report.machines
    )
    return f"Made with {packages or 'unknown versions'}; {machines}".replace("`", "").strip("; ")


def _templates() -> Environment:
    return Environment(
        loader=FileSystemLoader(_HERE / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


# What there is.


def _markdown_pages(folder: Path) -> dict[str, str]:
    """The page of each published Markdown file; the README of a folder is its index."""
    files = [*folder.glob("*.md"), *(f for name in _ROOMS for f in (folder / name).glob("*.md"))]
    places = sorted(file.relative_to(folder).as_posix() for file in files)
    made = {place: re.sub(r"(README)?\.md$", _html, place) for place in places}
    return {**made, **{name: page for name, page in _INDEX.items() if name in made}}


_ROOMS: Final = ("figures", "tables", "reference", "upstream")


def _html(ending: re.Match[str]) -> str:
    return "index.html" if ending[1] else ".html"


def _scene_pages(report: Report) -> dict[str, str]:
    return {scene: f"scenes/{of_scene(scene)}.html" for scene in report.scenes}


def _assets(palette: Palette) -> Iterator[tuple[str, str | bytes]]:
    """Style and scripts, the colours that the pictures ask for, and Plotly's script from its wheel."""
    for file in sorted((_HERE / "assets").iterdir()):
        yield f"assets/{file.name}", file.read_text(encoding="utf-8")
    colours = json.dumps(palette.document(), indent=1)
    made_by = MADE_BY.replace("<!--", "/*").replace("-->", "*/")
    yield "assets/palette.js", f"{made_by}\nwindow.sitePalette = {colours};\n"
    yield f"assets/{_SCRIPT}", _plotly()


def _plotly() -> bytes:
    spec = find_spec("plotly")
    if spec is None or not spec.submodule_search_locations:
        raise ImportError("expected plotly, got no such package", name="plotly")
    return Path(spec.submodule_search_locations[0], "package_data", _SCRIPT).read_bytes()


def _shown(file: Path) -> str | bytes:
    """A file as it is; a drawing made smaller."""
    return smaller(file.read_text(encoding="utf-8")) if file.suffix == ".svg" else file.read_bytes()


def _packed(files: Iterable[Path]) -> bytes:
    """One stream for all: files of the same digits are hardly larger together than one of them."""
    archive = io.BytesIO()
    with tarfile.open(fileobj=archive, mode="w:xz", format=tarfile.USTAR_FORMAT) as into:
        for file in files:
            content = file.read_bytes()
            named = tarfile.TarInfo(file.name)
            named.size = len(content)
            into.addfile(named, io.BytesIO(content))
    return archive.getvalue()


def _earlier(target: Path) -> list[Path]:
    """The files of an earlier site; ValueError for a folder with somebody else's."""
    files = [file for file in target.rglob("*") if file.is_file()] if target.exists() else []
    if files and not ((target / FRONT).exists() and first_line(target / FRONT) == MADE_BY):
        raise ValueError(f"expected a folder that is empty or has an earlier site, got {target}")
    return files
