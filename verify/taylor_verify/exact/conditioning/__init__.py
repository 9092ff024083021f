"""The derivative of the motion by its data and its state.

Two ways lead to it: differences of the exact solution, and the variational equations in float64.
"""
