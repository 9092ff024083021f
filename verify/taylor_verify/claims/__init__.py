"""The ledger: every numbered equation and every claim in words of the two source texts, checked.

The texts are a page of Heinbockel's tensor calculus (Euler's equations) and sections 48 and 49 of the
Encyclopaedia Britannica's Hydromechanics (Kirchhoff's equations), both as transcribed: a fault may
be the print's or the transcription's. Nothing here imports models or solvers.
"""
