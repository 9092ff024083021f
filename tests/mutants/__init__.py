"""Small changes of the code that a test has to notice: `make mutants`.

A script of our own. mutmut draws no sample and puts its switches into every function of the package;
cosmic-ray knows one command of tests for all files, and brings twenty packages. The tests that run a line
are found by coverage.
"""
