# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2", "sympy>=1.13"]
# ///
"""from_sympy reads the precision of a Float from mpmath's global context, not from the Float."""

import sys

import heyoka as hy

try:
    import mpmath
    import sympy
except ImportError:
    print("this needs sympy, which is not installed")
    sys.exit(2)

number = sympy.Float("0.1", 50)
plain = str(hy.from_sympy(number * sympy.Symbol("x")))
with mpmath.mp.workdps(50):
    wide = str(hy.from_sympy(number * sympy.Symbol("x")))

print("expected  the number's own 50 digits, as with mpmath.mp.workdps(50):", wide)
print("got      ", plain)
sys.exit(0 if plain == wide else 1)
