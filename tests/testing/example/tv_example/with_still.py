# /// script
# dependencies = []
# [tool.taylor-verify]
# title = "an engine that stands still"
# ///
"""An engine that stands still."""

import json
import sys

question = json.load(sys.stdin)
times = question["time"]["times"]["hex"]
answer = {name: [float(name == "q0")] * len(times) for name in question["columns"]}
json.dump({**answer, "t": times}, sys.stdout)
