"""Motions without a closed form, enclosed: a Taylor method whose every error is bounded in balls.

tape          a right-hand side as operations on nodes before it
operations    what each operation is asked, and sums of products; powers, functions and kinks are the others
loaded        the tapes of a scene; layout, piece_tapes, framing and lowering are their parts
series        the Taylor coefficients of all nodes in one step
bounds        what the series leave out, and how far a node is from its polynomial
tube          a bound of how far the motion is from its polynomial within one step
derivative    the derivative of the rates along a step, and flow, that of the motion
box           the set that contains the state, and how a step carries it on
crossing      steps that meet a kink
step          the length of a step, and all that is known of it
image         functions of the state over a box: values that are taken, with their jumps and rationals
walk          the steps of a course and its rows; stopping, when to give up
course        a motion from its start to requested times
"""
