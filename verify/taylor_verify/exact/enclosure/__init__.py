"""Motions without a closed form, enclosed: a Taylor method whose every error is bounded in balls.

system     the equations, quadratic, in exact rationals, and in balls
lamb       the coefficients of an ellipsoid in balls
series     their Taylor coefficients in balls
tube       a bound of how far the motion is from its polynomial within one step
box        the set that contains the state, and how a step carries it on
placing    attitude and centre along the step
course     the steps, the outputs and the precision
"""
