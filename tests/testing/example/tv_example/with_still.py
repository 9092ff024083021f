# /// script
# dependencies = []
# [tool.taylor-verify]
# title = "an engine that stands still"
# ///
"""An engine that stands still."""

import json
import sys

question = json.load(sys.stdin)
count = len(question["time"]["times"]["hex"])
json.dump({"states": [[0.0] * len(question["columns"])] * count}, sys.stdout)
