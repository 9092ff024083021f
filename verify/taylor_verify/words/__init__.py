"""Verdicts in words and tables: JUnit, GitHub, Markdown, CSV.

What a stored row says of itself is made in records/sentence.py and records/reason.py, because the row holds
it; everything else that is said of verdicts, causes and certificates is made here.
"""
