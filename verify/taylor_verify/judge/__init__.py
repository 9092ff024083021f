"""The judgement of a run: its errors against the truth, the roundoff floor, the gates and the verdicts."""
