"""Encyclopaedia Britannica, Hydromechanics, sections 48 and 49: Kirchhoff's equations."""
