"""A sweep on dask: who answers, who works, and what a lost worker costs."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from builders.sweeps import SOLVER, parts, swept

from taylor_verify.batch.cluster import Placed, executor_named
from taylor_verify.cli import main


def test_where_nobody_answers_there_is_one_clear_error(
    template: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """An address without a scheduler is refused within its seconds: exit status 2, one line."""
    pytest.importorskip("distributed", reason="dask is an extra: pip install 'taylor-verify[dask]'")
    dask = pytest.importorskip("dask")
    monkeypatch.setattr("taylor_verify.batch.cluster._PATIENCE", 0.5)
    began = time.monotonic()
    # By itself dask waits for these seconds.
    with dask.config.set({"distributed.comm.timeouts.connect": "600s"}):
        assert main(["sweep", template, "--executor", "dask:tcp://127.0.0.1:9"]) == 2
    assert time.monotonic() - began < 300
    *_, last = capsys.readouterr().err.splitlines()
    assert (
        "expected the address of a dask scheduler that answers within 0.5 s, such as dask:" in last
    )


def test_a_cluster_without_a_worker_is_named(
    template: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A sweep that waits for the first worker of a cluster says so."""

    @contextmanager
    def placed(name: str) -> Iterator[Placed]:
        del name
        yield Placed(None, ahead=1, workers=0)

    monkeypatch.setattr("taylor_verify.cli.sweep.executor_named", placed)
    words = ["--count", "1", "--solver", SOLVER, "--executor", "dask:tcp://head:8786"]
    assert main(["sweep", template, *words]) == 0
    assert "the dask scheduler has no worker yet" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL")
@pytest.mark.filterwarnings("default")
def test_a_dask_worker_that_is_killed_loses_nothing(template: str, tmp_path: Path) -> None:
    """One of two workers of a cluster is killed in the middle: the bytes are those of one process."""
    distributed = pytest.importorskip(
        "distributed", reason="dask is an extra: pip install 'taylor-verify[dask]'"
    )
    swept(template, tmp_path / "here", jobs=1)
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    out = tmp_path / "out"
    with cluster, executor_named(f"dask:{cluster.scheduler_address}") as placed:
        assert placed.workers == 2
        with distributed.Client(cluster) as client:
            victim = next(iter(client.run(os.getpid).values()))

        class Killing(Executor):
            """The executor of dask, whose worker is killed when the third chunk is submitted."""

            count = 0

            def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
                self.count += 1
                if self.count == 3:
                    os.kill(victim, signal.SIGKILL)
                return placed.executor.submit(fn, *args, **kwargs)

        swept(template, out, jobs=None, executor=Killing())
    assert parts(out) == parts(tmp_path / "here")
