"""The judgement: errors against the truth, what perfect rounding would leave, gates and verdicts."""
