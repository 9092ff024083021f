"""The table of traps: plain calls of heyoka, measured beside this suite's driver.

A report to heyoka's authors, and no part of the package. The calls that a script of reports/upstream has
are imported from there; their bodies are published as they stand.
"""
