"""The README tells the truth: its table is that of the committed reports, its example runs."""

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
VERDICTS = ROOT / "reports" / "data" / "verdicts.json"
RUNGS = ("f32", "f64", "f80", "f128", "mp237")


def table_rows() -> list[list[str]]:
    """The cells of the README's table of errors, a list for each line."""
    lines = [line for line in README.splitlines() if line.startswith("| `")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


@pytest.mark.parametrize("row", table_rows(), ids=lambda row: " ".join(row[:2]))
def test_table_is_that_of_the_committed_reports(row: list[str]) -> None:
    """Each cell is max/u (ratio) of the verdict in reports/data, to the digits printed."""
    published = json.loads(VERDICTS.read_text(encoding="utf-8"))["verdicts"]
    scene, quantity, *cells = row
    expected = [
        f"{v['max'] / v['roundoff']:.3g} u ({v['ratio']:.2g})"
        for rung in RUNGS
        for v in published
        if (f"`{v['scene']}`", v["quantity"], v["rung"]) == (scene, quantity, rung)
    ]
    assert cells == expected


def test_every_file_that_is_linked_exists() -> None:
    """No link of the README leads nowhere in the checkout."""
    links = re.findall(r"\]\((?!https?:)([^)#]+)", README)
    assert links
    assert [link for link in links if not (ROOT / link).exists()] == []


def test_every_regime_is_documented() -> None:
    """The words that `regime` can be are listed where a reader looks for them."""
    from verify.exact.euler.moments.regime import MomentRegime
    from verify.exact.euler.regime import Regime

    kirchhoff = (
        *("rest", "steady", "four-roots", "two-roots", "cubic", "hyperbolic"),
        *("trigonometric", "algebraic", "heteroclinic", "euler-top"),
        *("planar-swing", "planar-turn", "planar-front", "planar-uniform", "planar-steady"),
    )
    euler = [regime.value for regime in (*Regime, *MomentRegime)]
    for word in (*euler, *kirchhoff, "no closed form"):
        assert word in README
