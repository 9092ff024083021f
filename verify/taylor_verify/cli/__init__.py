"""The command line: arguments and printing, nothing else.

Exit status: 0 pass; 1 a gate failed; 2 no answer, because the input, the call or the machine was
wrong; 3 undecided (nothing failed). Nothing heavy is imported before a verb needs it, so that
`--help` answers at once.
"""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence

from taylor_verify.cli.answer import INTERRUPTED, PASS, WRONG_CALL, Answer, WrongCall, lines_of
from taylor_verify.cli.interrupts import heard_once
from taylor_verify.cli.streams import (
    MANNER,
    as_json_text,
    have_streams,
    print_out,
    say,
    stdout_reserved,
    tell,
    tell_runner,
)
from taylor_verify.records.escapes import one_line


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one verb and return the exit status."""
    with heard_once(to_the_end=arguments is None):
        return _status(sys.argv[1:] if arguments is None else arguments)


def _status(arguments: Sequence[str]) -> int:
    try:
        # Imported inside the try, so that an interrupt during the import is reported too.
        from taylor_verify.cli.arguments import parse

        have_streams()
        options = parse(arguments)
        MANNER.quiet, MANNER.colour = options.quiet, options.color
        with stdout_reserved():
            answer = _acted(options)
        return _print(answer, options.json)
    except KeyboardInterrupt as interrupt:
        tell(_interruption(interrupt))
        return INTERRUPTED
    except Exception as error:
        if sys.flags.dev_mode:
            raise
        return _refused(_message(error), arguments)
    except SystemExit as end:
        # The parser has printed its own message.
        _print_faults(getattr(end, "faults", ()), arguments)
        raise
    finally:
        print_out()


def _acted(options: Namespace) -> Answer:
    """Return the answer of a verb; code of others that ends the program, with any status, gives none."""
    try:
        answer: Answer = options.act(options)
    except SystemExit as end:
        message = f"expected an answer, got sys.exit({end.code!r:.60}) from a function or module"
        raise WrongCall(f"{message} that was called") from end
    return answer


def _print(answer: Answer, as_json: bool) -> int:
    shown = ""
    if as_json:
        print_out(as_json_text(answer.document))
    else:
        text = answer.short_text if MANNER.quiet else answer.text()
        print_out(text)
        # On a terminal both streams are read together, the text folded to its width.
        shown = "".join(text.split()) if sys.stdout.isatty() else ""
    # Where nothing else says what is wrong, a message does.
    is_needed = answer.status == WRONG_CALL or (answer.status != PASS and not answer.failing)
    for message in answer.messages:
        if "".join(message.split()) not in shown:
            (tell if is_needed else say)(message)
    return answer.status


def _refused(lines: Sequence[str], arguments: Sequence[str]) -> int:
    """Print a message on stderr, and on stdout as the document that --json asks for."""
    tell(*lines)
    _print_faults(lines, arguments)
    return WRONG_CALL


def _print_faults(lines: Sequence[str], arguments: Sequence[str]) -> None:
    # Options may not have been read: it is the words of the call that ask for an annotation or a document.
    if lines and "--github" in arguments:
        from taylor_verify.words.annotations import fault_line

        tell_runner(fault_line(lines))
    if lines and "--json" in arguments:
        faults = [*map(one_line, lines)]
        print_out(as_json_text({"error": "\n".join(faults), "faults": faults}))


def _interruption(interrupt: KeyboardInterrupt) -> str:
    """Return one line: how many scenes are finished, and how to go on."""
    finished, jobs = getattr(interrupt, "finished", 0), getattr(interrupt, "jobs", 0)
    if not finished:
        return "interrupted"
    return (
        f"interrupted: {finished} of {jobs} scenes are finished and kept, no report is written; the "
        "same command with --resume goes on from there"
    )


def _message(error: Exception) -> Sequence[str]:
    """Return the lines of a message without a traceback, which `python -X dev -m taylor_verify` shows."""
    from taylor_verify.records.faults import Refused

    if isinstance(error, WrongCall | Refused):
        return lines_of(error)
    return [_sentence(error)]


def _sentence(error: Exception) -> str:
    if isinstance(error, OSError):
        place = f" @ {error.filename}" if error.filename else ""
        return f"expected to read and write files, got {str(error.strerror or error)!r}{place}"
    ours = __name__.partition(".")[0]
    if isinstance(error, ModuleNotFoundError) and (error.name or ours).split(".")[0] != ours:
        from taylor_verify.solvers.taylor import package

        if error.name == package.NAME:
            return package.sentence(error)
        return f"expected the package {error.name} (pip install {error.name}), got none"
    from taylor_verify.batch.failure import Failed, fault

    return str(error) if isinstance(error, Failed) else fault(error)
