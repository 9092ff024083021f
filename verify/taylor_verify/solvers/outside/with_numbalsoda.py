# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["numbalsoda==0.3.4"]
# [tool.taylor-verify]
# title = "numbalsoda"
# unavailable = """\
#   numbalsoda 0.3.4 has no wheels, and to build it takes a Fortran compiler: its LSODA and DOP853 \
#   are entered by CyRK, as outside:cyrk-lsoda and outside:cyrk-dop853"""
# [tool.taylor-verify.methods]
# dop853 = "Dormand-Prince 8(5,3)"
# lsoda = "ODEPACK's LSODA"
# [tool.taylor-verify.settings]
# rtol = 1e-9
# atol = "rtol"
# ///
"""numbalsoda, which cannot be installed like the others: this file gives its name and the reason."""
