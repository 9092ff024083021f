"""The verb `board`: the boards of engines, one row's trajectory, and one's own engine beside the others."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.cli.answer import FAIL, PASS, UNDECIDED, Answer, WrongCall, wrong_calls
from taylor_verify.cli.folders import alone_in, writable, writable_file
from taylor_verify.cli.streams import say
from taylor_verify_reports.verbs.checkout import reports_folder

if TYPE_CHECKING:
    from taylor_verify_reports.studies.engines.answer import Answer as Run
    from taylor_verify_reports.studies.engines.document import EngineRow
    from taylor_verify_reports.studies.engines.own import OwnEngine

_SENDING: Final = (
    "To send it: open an issue with the folder {place} (rows and trajectories, each of which `check` "
    "judges alone) and the program that made it, or a merge request with an adapter and a row of the "
    "list (cases/README.md, To add an engine)."
)

# The command line splits what is called `files` and `scenes` by itself.
_STORED_AS: Final = {"files": "results", "scene": "only_scenes"}

help = "show the boards of engines, or put an engine of your own on a local copy"
example = 'board add my-engine --solver "process:python my_engine.py {step}" --steps 0.02,0.01'


def add(verb: argparse.ArgumentParser) -> None:
    """Add the arguments of the verb."""
    verb.add_argument(
        "words",
        nargs="*",
        metavar="add NAME",
        help="judge your own engine on the scenes of the boards, and make a copy of their pages and "
        "tables with it in reports/local/boards; default: show the boards",
    )
    verb.add_argument(
        "--solver",
        metavar="S",
        help="any solver: outside:NAME?..., python:package.module:function, process:COMMAND; {step} in it "
        "stands for each of --steps",
    )
    verb.add_argument(
        "--files",
        dest="results",
        metavar="DIR",
        help="files of results in place of a solver: DIR/oblique.csv and so on, named for the scenes, or "
        "DIR/STEP/oblique.csv; any format that `check` reads",
    )
    verb.add_argument("--steps", metavar="H,H,...", default="", help="the steps, as decimal text")
    verb.add_argument(
        "--board", metavar="BOARD", help="engines, satellite or underwater; default: all"
    )
    verb.add_argument(
        "--scene",
        dest="only_scenes",
        nargs="*",
        default=[],
        metavar="SCENE",
        help="only these scenes",
    )
    verb.add_argument(
        "--rung", default="f64", metavar="R", help="precision of the engine's arithmetic"
    )
    verb.add_argument(
        "--load", default="", metavar="WORDS", help='how loads reach it, "held over each step"'
    )
    verb.add_argument("--anew", action="store_true", help="also run again what is stored")
    verb.add_argument(
        "--row",
        metavar="N",
        help="write the trajectory of row N of --board (the numbers of its page and of `board --json`), "
        "for `check`; its engine makes it again",
    )
    verb.add_argument("--out", metavar="FILE", help="the file of --row; default: standard output")
    verb.add_argument(
        "--from",
        dest="folder",
        metavar="DIR",
        help="the folder of reports; default: the checkout's",
    )


def run(options: argparse.Namespace) -> Answer:
    """Show the boards, write a trajectory, or measure one's own engine."""
    from taylor_verify_reports.studies.engines.entry import BOARDS

    if options.board is not None and options.board not in BOARDS:
        raise WrongCall(f"expected one of {', '.join(BOARDS)}, got {options.board!r:.60} @ --board")
    folder = Path(reports_folder(options.folder, measures=False))
    if not folder.is_dir():
        raise WrongCall(f"expected the folder of reports, got {str(folder)!r:.60} @ --from")
    boards = [options.board] if options.board else [*BOARDS]
    if options.words:
        return _added(options, folder, boards)
    for name in ("solver", "files", "steps", "load", "scene", "anew"):
        if getattr(options, _STORED_AS.get(name, name)):
            raise WrongCall(f"expected --{name} with `board add NAME`, got it without @ board")
    if options.row is not None:
        return _trajectory(options, folder)
    if options.out is not None:
        raise WrongCall("expected --out with --row, got it without @ board")
    return _shown(folder, boards)


def _shown(folder: Path, boards: Sequence[str]) -> Answer:
    """Return what is stored of the boards; their rows are in the JSON."""
    documents = [_document(folder, name) for name in boards]
    return Answer(PASS, {"boards": documents}, lambda: "\n\n".join(map(_text, documents)))


def _document(folder: Path, name: str) -> dict[str, Any]:
    from taylor_verify_reports.studies.engines import own
    from taylor_verify_reports.studies.engines.advice import advice

    with wrong_calls():
        board, entries, mine = own.read(folder, name)
    published = 0 if board is None else len(board.study.rows)
    ours = own.with_own(board, mine, name)
    files = [""] * published + [os.path.relpath(own.file_of(folder, name, a), folder) for a in mine]
    rows = [
        _row(number, row, file)
        for number, (row, file) in enumerate(zip(ours.study.rows, files, strict=True))
    ]
    return {
        "name": name,
        "title": entries.about.title,
        "page": str(folder / f"tables/{name}.md"),
        "scenes": list(dict.fromkeys(row["scene"] for row in rows)),
        "advice": advice(ours, entries),
        "own": sorted({answer.row.engine for answer in mine}),
        "rows": rows,
    }


def _row(number: int, row: EngineRow, file: str) -> dict[str, Any]:
    """Return a row with its number, the file of its trajectory if it is one's own, and its command."""
    from taylor_verify.records.json_text import complete

    return {
        "row": number,
        **complete(row),
        "file": file or None,
        "command": f'taylor-verify run {row.scene} --solver "{row.solver}" --rung {row.rung}',
    }


def _text(board: dict[str, Any]) -> str:
    rows = board["rows"]
    engines = len({row["engine"] for row in rows})
    count = (
        f"{engines} engines, {len(board['scenes'])} scenes, {len(rows)} rows"
        if rows
        else "not measured"
    )
    lines = [f"{board['name']}: {board['title']} ({count}; {board['page']})"]
    lines += [f"  {sentence.replace('**', '').replace('`', '')}" for sentence in board["advice"]]
    lines += [f"  your own: {', '.join(board['own'])}"] if board["own"] else []
    return "\n".join(lines)


def _trajectory(options: argparse.Namespace, folder: Path) -> Answer:
    """Write the trajectory of a row as columns, which `check` reads."""
    from taylor_verify_reports.studies.engines import own

    if options.board is None:
        raise WrongCall("expected --board with --row, got none @ --board")
    file = None
    if options.out is not None:
        if Path(options.out).suffix != ".json":
            raise WrongCall(f"expected a name that ends in .json, got {options.out!r:.60} @ --out")
        file = writable_file(options.out, "--out")
    with wrong_calls():
        answers = own.every_answer(folder, options.board)
    text = options.row
    if not text.isdecimal() or int(text) >= len(answers):
        raise WrongCall(f"expected a row from 0 to {len(answers) - 1}, got {text!r:.40} @ --row")
    answer = answers[int(text)]
    copy = own.file_of(folder, options.board, answer)
    if answer.states is None and copy.exists() and answer.row.is_judged:
        raise WrongCall(
            f"expected a row that an engine makes, got the file {copy} (`check {copy} --scene "
            f"{answer.row.scene}`) @ --row"
        )
    if answer.states is None:
        answer = _made_again(answer, options.board)
    columns = answer.columns()
    check = f"taylor-verify check FILE --scene {answer.row.scene} --rung {answer.row.rung}"
    if file is None:
        return Answer(PASS, columns, answer.to_text, [check])
    file.write_text(answer.to_text(), encoding="utf-8")
    return Answer(
        PASS, {"written": [str(file)]}, lambda: str(file), [check.replace("FILE", str(file))]
    )


def _made_again(answer: Run, board: str) -> Run:
    """Return the answer of a published row: its engine runs once more."""
    from taylor_verify_reports.studies.engines.answer import answered
    from taylor_verify_reports.studies.engines.entry import entry_list

    row = answer.row
    asked = next((run for run in entry_list(board).runs() if run.key == row.key), None)
    if row.is_judged and asked is not None:
        say(f"making the trajectory of {row.key}")
        (answer,) = answered([asked])
    if answer.states is None:
        standing = f"{answer.row.standing}: {answer.row.detail}"
        raise WrongCall(f"expected a row with a trajectory, got one that is {standing} @ --row")
    return answer


def _added(options: argparse.Namespace, folder: Path, boards: Sequence[str]) -> Answer:
    """Measure one's own engine on the boards, and make the copies of their pages."""
    from taylor_verify_reports.studies.engines import own

    engine = _engine(options, boards)
    writable(str(folder), "--from")
    runs, pages = list[Any](), list[str]()
    with alone_in(folder / own.OWN, "--from"):
        for name in boards:
            with wrong_calls():
                runs += own.add(folder, engine, name, options.only_scenes, say, options.anew)
                pages.append(str(own.copied(folder, name)))
    rows = [_row(k, answer.row, "") for k, answer in enumerate(runs)]
    return Answer(
        _status(runs),
        {"rows": rows, "pages": pages},
        lambda: "\n".join([*map(_line, runs), *pages]),
        [_SENDING.format(place=folder / own.OWN / engine.name)]
        if any(answer.row.is_judged for answer in runs)
        else [],
    )


def _engine(options: argparse.Namespace, boards: Sequence[str]) -> OwnEngine:
    """Return the engine of a call. Raises WrongCall with every fault of it."""
    from taylor_verify.cli.inputs import known_rungs
    from taylor_verify_reports.studies.engines import own
    from taylor_verify_reports.studies.engines.entry import entry_list

    if len(options.words) != 2 or options.words[0] != "add":
        raise WrongCall(
            f"expected `board` or `board add NAME`, got {' '.join(options.words)!r:.60}"
        )
    (rung,) = known_rungs([options.rung])
    steps = tuple(filter(None, options.steps.split(",")))
    engine = own.OwnEngine(
        options.words[1], options.solver or "", options.results or "", steps, rung, options.load
    )
    scenes = [scene.name for board in boards for scene in entry_list(board).scene]
    faults = [*own.faults_of(engine), *_faults(options, scenes)]
    if faults:
        raise WrongCall(*faults)
    return engine


def _faults(options: argparse.Namespace, scenes: Sequence[str]) -> Iterator[str]:
    from taylor_verify.solvers.registry import solver_named
    from taylor_verify_reports.studies.engines.entry import STEP

    for scene in options.only_scenes:
        if scene not in scenes:
            yield f"expected a scene of the board, got {scene!r:.60} ({', '.join(scenes)}) @ --scene"
    if options.solver:
        try:
            solver_named(options.solver.replace(STEP, options.steps.split(",")[0]))
        except ValueError as error:
            yield f"{error} @ --solver"
    if options.results and not Path(options.results).is_dir():
        yield f"expected a folder of files, got {options.results!r:.60} @ --files"


def _status(runs: Sequence[Run]) -> int:
    """Return the exit status: a run that failed, or nothing that was judged, is no success."""
    if any(run.row.standing == "failed" for run in runs):
        return FAIL
    return PASS if any(run.row.is_judged for run in runs) else UNDECIDED


def _line(run: Run) -> str:
    row = run.row
    step = f" step {row.value}" if row.value else ""
    errors = ", ".join(
        f"{name} {row.errors[name]:.2e}" for name in row.floors if name in row.errors
    )
    return f"{row.scene}{step}: {errors or f'{row.standing}, {row.detail}'}"
