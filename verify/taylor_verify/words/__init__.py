"""Verdicts in words and tables: JUnit, GitHub, Markdown, CSV."""
