"""Types of the public functions by name; each is imported when it is first asked for.

Annotations are written ``types.Scene``, so that `typing.get_type_hints` finds them, and
`import taylor_verify` brings in no library of numbers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from concurrent.futures import Executor as Executor

    from taylor_verify.batch.chosen_scenes import Selection as Selection
    from taylor_verify.batch.judgements import Judgements as Judgements
    from taylor_verify.batch.judging import Progress as Progress
    from taylor_verify.certify.certificate import Certificate as Certificate
    from taylor_verify.exact.event_times import Events as Events
    from taylor_verify.judge.events import EventsJudgement as EventsJudgement
    from taylor_verify.judge.judgement import Judgement as Judgement
    from taylor_verify.judge.series.files import FilesJudgement as FilesJudgement
    from taylor_verify.judge.tolerances import Tolerance as Tolerance
    from taylor_verify.judge.tolerances import Tolerances as Tolerances
    from taylor_verify.models.problem import Problem as Problem
    from taylor_verify.numbers.precision import Rung as Rung
    from taylor_verify.records.faults import Refused as Refused
    from taylor_verify.records.sweep import SweepSummary as SweepSummary
    from taylor_verify.records.verdict import Verdict as Verdict
    from taylor_verify.scenes.motion import Motion as Motion
    from taylor_verify.scenes.scene import Scene as Scene
    from taylor_verify.solvers.files.file import TrajectoryFile as TrajectoryFile
    from taylor_verify.solvers.solver import Solver as Solver
    from taylor_verify.solvers.trajectory import Trajectory as Trajectory
    from taylor_verify.tradeoff.recommendation import Recommendation as Recommendation
    from taylor_verify.tradeoff.setting import Setting as Setting
    from taylor_verify.tradeoff.trade_off import TradeOff as TradeOff
else:
    _PLACES = {
        "Certificate": "taylor_verify.certify.certificate",
        "Events": "taylor_verify.exact.event_times",
        "EventsJudgement": "taylor_verify.judge.events",
        "Executor": "concurrent.futures",
        "FilesJudgement": "taylor_verify.judge.series.files",
        "Judgement": "taylor_verify.judge.judgement",
        "Judgements": "taylor_verify.batch.judgements",
        "Motion": "taylor_verify.scenes.motion",
        "Problem": "taylor_verify.models.problem",
        "Progress": "taylor_verify.batch.judging",
        "Recommendation": "taylor_verify.tradeoff.recommendation",
        "Refused": "taylor_verify.records.faults",
        "Rung": "taylor_verify.numbers.precision",
        "Scene": "taylor_verify.scenes.scene",
        "Selection": "taylor_verify.batch.chosen_scenes",
        "Setting": "taylor_verify.tradeoff.setting",
        "Solver": "taylor_verify.solvers.solver",
        "SweepSummary": "taylor_verify.records.sweep",
        "Tolerance": "taylor_verify.judge.tolerances",
        "Tolerances": "taylor_verify.judge.tolerances",
        "TradeOff": "taylor_verify.tradeoff.trade_off",
        "Trajectory": "taylor_verify.solvers.trajectory",
        "TrajectoryFile": "taylor_verify.solvers.files.file",
        "Verdict": "taylor_verify.records.verdict",
    }

    def __getattr__(name):
        from importlib import import_module

        if name not in _PLACES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(import_module(_PLACES[name]), name)
