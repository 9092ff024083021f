"""The error that perfect rounding would leave, and the inputs that it follows from."""
