"""The parser of arguments, whose words are printed as any other answer."""

from __future__ import annotations

import argparse
import sys
from typing import Any, NoReturn

from taylor_verify.cli.streams import print_out
from taylor_verify.scenes.names import one_line


class Parser(argparse.ArgumentParser):
    """A parser whose message is one harmless line: it repeats words that may be names of files."""

    def error(self, message: str) -> NoReturn:
        super().error(one_line(message))

    def _print_message(self, message: str, file: Any = None) -> None:
        # argparse itself says nothing of a disk that is full.
        if file is sys.stderr:
            super()._print_message(message, file)
        else:
            print_out(message.removesuffix("\n"))
