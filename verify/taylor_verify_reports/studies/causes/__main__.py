"""python -m taylor_verify_reports.studies.causes FILE [--seed N] [--count N]: write the confusion table.

What is false stands below the table, sentence by sentence.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from taylor_verify_reports.studies.causes.measure import measured, table


def main() -> None:
    """Write the table of the kinds."""
    parser = argparse.ArgumentParser(prog="taylor_verify_reports.studies.causes")
    parser.add_argument("file", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20)
    asked = parser.parse_args()
    answers = list(measured(asked.seed, asked.count))
    false = [
        f"- {named.kind}, {named.sort}: {' ## '.join(named.sentences)}"
        for named in answers
        if named.outcome == "false"
    ]
    asked.file.write_text("\n".join([table(answers), "", *false]))


if __name__ == "__main__":
    main()
