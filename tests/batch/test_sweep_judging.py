"""A sweep judges as `run` does: by a tolerance, and with the causes of the worst failures."""

from __future__ import annotations

import json
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.sweeps import FAILING, SOLVER, TEMPLATE, rows, swept

from taylor_verify.batch.sweeps import chunk as chunks
from taylor_verify.batch.sweeps.sizes import Sizes
from taylor_verify.cli import main
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.faults import Refused
from taylor_verify.run import run
from taylor_verify.scenes.scene import Scene

# A simulator whose body goes on as it began.
STILL = """
import json, sys
asked = json.load(sys.stdin)
times = asked["time"]["times"]["hex"]
w = asked["initial"]["omega"]["hex"]
rows = {n: [v] * len(times) for n, v in zip(("w1", "w2", "w3"), w)}
json.dump({"t": times, **rows}, sys.stdout)
"""


# Causes.


def test_a_worst_case_that_failed_has_the_causes_that_run_finds(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """They stand in the summary, in its page and in the text; one that passed has none."""
    (tmp_path / "still.py").write_text(STILL)
    solver = f"process:{sys.executable} {tmp_path / 'still.py'}"
    file, out = tmp_path / "small.toml", tmp_path / "out"
    file.write_text(TEMPLATE.replace("samples = 3", "samples = 21"))
    words = ["sweep", str(file), "--count", "1", "--jobs", "1", "--worst", "1"]
    assert main([*words, "--solver", solver, "--out", str(out)]) == 1
    assert "likely cause: no gyroscopic term; " in capsys.readouterr().out
    (case,) = json.loads((out / "summary.json").read_text())["worst"]
    causes = [cause.sentence for cause in run(out / case["file"], solver).causes]
    assert case["causes"] == causes != []
    assert "| likely cause |" in (out / "summary.md").read_text()
    assert main([*words, "--solver", SOLVER]) == 0
    assert "likely cause" not in capsys.readouterr().out


@pytest.mark.parametrize("executor", ["here", "threads"])
def test_causes_are_sought_for_the_worst_cases_alone(
    template: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, executor: str
) -> None:
    """Two of twenty bodies that fail are explained, by whatever executor judges them."""
    explained: list[str] = []

    def counted(scene: Scene, *given: Any, causes: bool = True) -> Judgement:
        explained.extend([scene.name] * causes)
        return run(scene, *given, causes=False)

    monkeypatch.setattr(chunks, "judge_scene", counted)
    with ThreadPoolExecutor(1) as threads:
        result = swept(
            template,
            tmp_path / "out",
            solver=FAILING,
            worst=2,
            executor=threads if executor == "threads" else None,
        )
    assert result.bodies["fail"] == 20
    assert sorted(explained) == sorted(case.scene for case in result.worst)


# A tolerance.


def test_a_tolerance_replaces_the_bounds_as_in_run(template: str, tmp_path: Path) -> None:
    """Bodies that fail by the arithmetic pass a looser tolerance; rows have the bound that run has."""
    assert swept(template, tmp_path / "none", solver=FAILING, count=1).exit_status == 1
    result = swept(template, tmp_path / "out", solver=FAILING, count=1, tolerance=1e-2, worst=1)
    assert (result.exit_status, result.tolerance) == (0, "0.01")
    (case,) = result.worst
    verdicts = run(tmp_path / "out" / case.file, FAILING, tolerance=1e-2).verdicts
    mine = [row for row in rows(tmp_path / "out") if row["point"] == case.point]
    assert [(row["quantity"], row["bound"]) for row in mine] == [
        (verdict.quantity, verdict.bound) for verdict in verdicts
    ]
    assert "above the tolerance 0.01" in (tmp_path / "out" / "summary.md").read_text()


def test_the_command_takes_a_tolerance_by_name(
    template: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Quantities without one keep their bounds; a name that is no quantity is refused."""
    words = ["sweep", template, "--solver", FAILING, "--count", "1", "--jobs", "1"]
    assert main([*words, "--tolerance", "omega=1e-2,T=1e-2,H2=1e-2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["tolerance"] == "H2=0.01,T=0.01,omega=0.01"
    assert main([*words, "--tolerance", "omega=1e-2", "--json"]) == 1
    assert main([*words, "--tolerance", "attitude=1e-2"]) == 2
    assert "got attitude @ tolerance" in capsys.readouterr().err


def test_a_sweep_is_resumed_with_its_own_tolerance(template: str, tmp_path: Path) -> None:
    """Another one is refused, and so is one for a sweep that had none."""
    swept(template, tmp_path / "none", count=1)
    expected = "expected tolerance none as in the sweep that is there, got 0.001 @ resume"
    with pytest.raises(Refused, match=expected):
        swept(template, tmp_path / "none", count=1, tolerance=1e-3, resume=True)
    swept(template, tmp_path / "out", count=1, tolerance=1e-2)
    with pytest.raises(Refused, match=r"expected tolerance 0\.01 .* got none @ resume"):
        swept(template, tmp_path / "out", count=1, resume=True)
    swept(template, tmp_path / "out", count=1, tolerance=1e-2, resume=True)


# Quantiles of sizes, counted part by part.


def test_quantiles_are_sizes_that_occurred() -> None:
    """Counted in parts, each quantile is at most a thousandth above the exact one; the largest is exact."""
    drawn = np.exp(np.random.default_rng(1).normal(0, 3, 5000))
    sizes = Sizes()
    for part in np.array_split(drawn, 7):
        sizes.add(part)
    quantiles = sizes.quantiles()
    for share, size in (
        (0.5, quantiles.median),
        (0.9, quantiles.p90),
        (0.99, quantiles.p99),
    ):
        exact = np.sort(drawn)[int(np.ceil(share * len(drawn))) - 1]
        assert size in drawn
        assert exact <= size <= exact * 1.001
    assert quantiles.largest == drawn.max()


def test_nan_is_beyond_every_number() -> None:
    """One NaN among a hundred is the largest, and no number."""
    sizes = Sizes()
    sizes.add(np.array([*np.linspace(0, 1, 99), np.nan]))
    quantiles = sizes.quantiles()
    assert quantiles.largest is None
    assert quantiles.p90 is not None
    assert Sizes().quantiles() is None
