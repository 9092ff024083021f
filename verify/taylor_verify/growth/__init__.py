"""How errors grow over decades of time: an ensemble of starts, followed far and held to the truth.

question -> course (checkpoint) -> errors -> measured growth. The statistics are those of judge.growth.
"""
