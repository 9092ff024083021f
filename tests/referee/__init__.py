"""A referee of `taylor-verify exact` that imports nothing of the package it judges.

It reads the text of a scene, moves the body by Taylor series of its own in MPFR, and compares every
printed number with its own. The physics is on one page, in `bodies` (which body), `equations` (how it
moves) and `lamb` (what a fluid adds to an ellipsoid). All vectors are in body axes, but for the centre:

    rigid body with wheels   p = I w,     p' = (p + h) x w + M - c p
    solid in an ideal fluid  x' = x x W + X - c x,     y' = y x W + x x U + L - c y
                             U = A x + B y,     W = B^T x + C y
    attitude                 R' = R [W]x: each row e of R obeys e' = e x W
    centre, space axes       c' = R U
"""
