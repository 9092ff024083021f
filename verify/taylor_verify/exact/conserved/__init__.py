"""What written loads conserve, found as exact polynomials that are zero."""
