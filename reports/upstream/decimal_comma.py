# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""Code for real128 depends on the locale: with a decimal comma it computes something else.

x' = -x from x(0) = 1. Between two identical integrators the process takes a locale with a decimal comma.
"""

import locale
import sys

import heyoka as hy

COMMAS = ("de_DE.UTF-8", "fr_FR.UTF-8", "it_IT.UTF-8", "es_ES.UTF-8", "nl_NL.UTF-8")


def steps():
    """The outcome of a propagation by newly compiled code, and the number of its steps."""
    hy.llvm_state.clear_memcache()
    ta = hy.taylor_adaptive([(x, -x)], [hy.real128(1)], fp_type=hy.real128)
    outcome, _, _, taken, *_ = ta.propagate_until(hy.real128(3), max_steps=1000)
    return outcome, taken


def set_comma():
    """Take the first of the locales that there is; False if there is none."""
    for name in COMMAS:
        try:
            locale.setlocale(locale.LC_ALL, name)
        except locale.Error:
            continue
        return True
    return False


if not hasattr(hy, "real128"):
    sys.exit(2)
hy.llvm_state.set_diskcache_enabled(False)
x = hy.make_vars("x")
expected = steps()
if not set_comma():
    print("no locale with a decimal comma here")
    sys.exit(2)
got = steps()
print("expected  the same in every locale:", *expected)
print("got      ", *got, "with a decimal comma")
sys.exit(0 if got == expected else 1)
