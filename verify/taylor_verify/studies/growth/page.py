"""How errors grow over decades of time: the stored ensembles, and the page and picture made of them.

growth.json        the published ensembles: of every quantity its root mean squares and the gate
growth-long.json   the same of the long run, where somebody has made it
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from taylor_verify.publish.cells import NOTHING, figure
from taylor_verify.publish.markdown import Column, bold, bullets, code, prose, table
from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.records import store
from taylor_verify.records.json_text import complete, read
from taylor_verify.records.provenance import Provenance
from taylor_verify.records.replacement import replace_files
from taylor_verify.records.status import Status
from taylor_verify.studies import figures, measured
from taylor_verify.studies.growth import picture as diagram
from taylor_verify.studies.growth.document import (
    Ensemble,
    GrowthGate,
    GrowthOfQuantity,
    GrowthStudy,
    Number,
)

GROWTH: Final = f"{store.FOLDER}/growth.json"
LONG: Final = f"{store.FOLDER}/growth-long.json"
PAGE: Final = "tables/growth.md"
SHEET: Final = "tables/growth.csv"

_MADE_BY: Final = {"made_by": "taylor-verify publish --growth; do not edit"}
_MAKER: Final = "<!-- made by taylor-verify publish --growth; do not edit -->"

_WHAT: Final = (
    "If every rounding is independent of all others, what they do to a conserved quantity is a random "
    "walk and grows as the square root of time, and what they do to the phase, whose rate depends on "
    "the conserved quantities, grows as its three halves: Brouwer's law. An error that always has the "
    "same sign, however small, makes that 1 and 2, and in a long run it wins. Each ensemble here is a "
    "scene and starts within one per cent of it, followed by the Taylor integrator and compared with "
    "the exact motion of the same rounded data."
)
_LEGEND: Final = (
    "*rms* is the root mean square over the starts at the first and the last instant: drifts relative to "
    "the quantity's own size, the state relative to its largest, *phase* in radians of the orbit's "
    "period. *walks* is the last over u times the square root of the steps, u being the rung's unit "
    "roundoff: a walk whose every step is one u has 1.",
    "*exponent* is the mean of the starts' own slopes, log error against log time, with Student's "
    "interval at 99 %; it needs no assumption on how errors are distributed. *late* is that of the "
    "second half of the decades.",
    "The word is the one whose exponent the interval contains: bounded 0, random walk ½, bias 1; for "
    "phase and state one more, as they follow the rate (and *jitter* ½, *constant rate* 1). Where it "
    "contains several the word is *unclear*, where none, *between*; an interval of less than a "
    "twentieth on either side counts as so wide, as no error is a pure power of time.",
)
_NO_CONSERVATION: Final = (
    "A small drift certifies no state: compare it with the phase beside it, which is larger by a "
    "factor that itself grows with time."
)

_LEANING: Final = (
    "**Where roundings lean to one side.** A product with a coefficient of many random digits is rounded "
    "up as far as down. A coefficient that is a rounded small fraction, such as 1/6, leaves remainders "
    "that are nearly thirds of a unit in the last place; the coefficient's own rounding moves all of "
    "them to one side, and the mean rounding is up to a sixth of a unit, with a sign that "
    "hangs on the size of the other factor. An orbit that favours a size has a bias then, which no "
    "tolerance removes: round numbers make a handy example and a hard one."
)


def write(folder: Path | str, study: GrowthStudy, long: bool = False) -> list[Path]:
    """Store the ensembles below ``folder``, draw them where matplotlib is, and make the page.

    Raises OSError.
    """
    place = Path(folder)
    name = LONG if long else GROWTH
    stored = list(replace_files(place, {name: store.laid_out({**_MADE_BY, **complete(study)})}))
    return [*stored, *_drawn(place), *replace_files(place, pages(place))]


def pages(folder: Path) -> dict[str, str]:
    """Return the page of the ensembles stored below ``folder``; nothing where there are none.

    Raises OSError for files that cannot be read and ValueError for files that hold something else.
    """
    study = load(folder)
    if not study.runs:
        return {}
    with store.expecting("ensembles", folder / GROWTH):
        return {PAGE: page(study, _shown(folder, study)), SHEET: measured.growth(study.runs)}


def load(folder: Path) -> GrowthStudy:
    """Return both files as one study: the published runs, then the long ones; without files, no runs."""
    files = [folder / name for name in (GROWTH, LONG)]
    stored = [read(file, GrowthStudy) for file in files if file.exists()]
    return GrowthStudy(
        runs=tuple(run for study in stored for run in study.runs),
        left_out=tuple(one for study in stored for one in study.left_out),
        provenance=stored[0].provenance if stored else Provenance(),
    )


def page(study: GrowthStudy, pictures: str = "") -> str:
    """Return the whole page."""
    runs = study.runs
    blocks = [
        f"{_MAKER}\n# How errors grow with time",
        _WHAT,
        _gates(runs),
        bullets(prose(f"Left out: {one}.") for one in study.left_out),
        pictures,
        bullets(_LEGEND),
        *(block for run in runs for block in _section(run)),
        "## The gate",
        _gate_told(runs),
        _LEANING,
        _NO_CONSERVATION,
        "## To remake this",
        bullets(_remake(study.provenance)),
    ]
    return "\n\n".join(block for block in blocks if block) + "\n"


def picture_of(runs: Sequence[Ensemble]) -> Picture | None:
    """Return all ensembles in one picture; None where there is nothing above zero to draw."""
    try:
        return diagram.picture(runs)
    except ValueError:
        return None


def _drawn(place: Path) -> list[Path]:
    picture = picture_of(load(place).runs)
    if picture is None:
        return []
    try:
        return figures.draw(place, [picture])
    except ImportError:
        # The page says everything in numbers; a picture is for those who have matplotlib.
        return []


def _shown(place: Path, study: GrowthStudy) -> str:
    picture = picture_of(study.runs)
    return figures.shown(place, [picture]) if picture else ""


def _gates(runs: Iterable[Ensemble]) -> str:
    """Return how many gates passed, and the names of those that did not."""
    judged = [(run, row, row.gate) for run in runs for row in run.quantities if row.gate]
    failed = [f"{code(row.quantity)} of {_name(run)}" for run, row, gate in judged if _fails(gate)]
    told = f"{len(judged) - len(failed)} of {len(judged)} gates passed."
    return f"{told} Worse than a random walk: {'; '.join(failed)}." if failed else told


def _section(run: Ensemble) -> list[str]:
    lost = bold(f" {run.lost} of them did not reach the end.") if run.lost else ""
    told = (
        f"{run.lanes} starts from {_count(run.counts[0])} to {_count(run.counts[-1])} periods of "
        f"{figure(run.period)} each, {figure(run.steps[-1])} steps.{lost}"
    )
    columns = [
        Column("quantity"),
        *(Column(heading, True) for heading in ("rms, first", "rms, last", "walks", "exponent")),
        *(Column(heading) for heading in ("word", "late", "no worse than a walk")),
    ]
    return [
        f"## {_name(run)}",
        f"{prose(run.why.capitalize())}. {told}",
        table(columns, [_cells(row) for row in run.quantities]),
    ]


def _cells(row: GrowthOfQuantity) -> list[str]:
    return [
        code(row.quantity),
        figure(row.rms[0]),
        figure(row.rms[-1]),
        figure(row.in_walks),
        _interval(row.exponent, row.low, row.high) if row.word != "exact" else NOTHING,
        prose(row.word),
        _interval(*row.late) if row.late_word != "exact" else NOTHING,
        _verdict(row.gate),
    ]


def _interval(value: Number, low: Number, high: Number) -> str:
    if value is None or low is None or high is None:
        return NOTHING
    return f"{value:.2f} [{low:.2f}, {high:.2f}]"


def _verdict(gate: GrowthGate | None) -> str:
    if gate is None:
        return NOTHING
    word = bold(gate.verdict.value) if _fails(gate) else gate.verdict.value
    return f"{word}, chance {figure(gate.chance)}"


def _fails(gate: GrowthGate) -> bool:
    return gate.verdict is not Status.PASS


def _gate_told(runs: Sequence[Ensemble]) -> str:
    rates = {row.gate.false_alarm for run in runs for row in run.quantities if row.gate}
    rate = figure(max(rates)) if rates else NOTHING
    return (
        "*no worse than a walk* holds the last decade against those before it. A walk's increments over "
        "the square roots of their times are independent numbers of one variance, and the covariance of "
        "its integral makes the same of a phase; so the ratio of the late squares to the early ones has "
        "Fisher's distribution for every start, whatever the size of its roundings, and the starts "
        "together are chi-square. *chance* is how often a true walk looks so bad; the gate fails "
        f"below {rate}, which is how often a true walk fails it. The state has no gate: an error "
        "without a sign has no such distribution, and the phase says the same."
    )


def _remake(provenance: Provenance) -> list[str]:
    versions = ", ".join(f"{name} {version}" for name, version in provenance.versions.items())
    return [
        f"`taylor-verify publish --growth` follows the ensembles anew, writes [growth.json](../{GROWTH}), "
        "the picture and this page: minutes, all cores. It may be stopped and goes on from where it was.",
        "`taylor-verify publish --growth --long` follows the long run, 100 million periods, likewise: "
        "a thousand pieces of some seconds.",
        "Roundings are other draws on another processor, and so are the last digits here; the exponents "
        "are the same within their intervals.",
        f"Machine: {prose(provenance.processor)}; {versions}. Made by {code(provenance.command)}.",
    ]


def _name(run: Ensemble) -> str:
    return f"{run.scene} on {run.rung}, {run.solver}"


def _count(periods: float) -> str:
    """Half-decades: 100, 3.16e3, 1e6."""
    return f"{periods:.3g}".replace("e+0", "e")
