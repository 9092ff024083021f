# /// script
# requires-python = ">=3.11"
# dependencies = ["heyoka==7.13.2", "numpy>=2"]
# ///
"""Code for `hy.real` that one process stores in the disk cache is never found by another.

The code of two processes differs in one thing: the significand of a zero, which nothing sets or reads.
"""

import sqlite3
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

PROGRAM = """
import sys
import heyoka as hy
hy.llvm_state.set_diskcache_path(sys.argv[1])
x, one = hy.make_vars("x"), hy.real(1, 237)
hy.taylor_adaptive([(x, -x)], [one], time=0 * one, fp_type=hy.real, compact_mode=True)
"""

if __name__ == "__main__":
    with TemporaryDirectory() as folder:
        for _ in range(3):
            subprocess.run([sys.executable, "-c", PROGRAM, folder], check=True)
        connection = sqlite3.connect(Path(folder, "cache.db"))
        keys = [key for (key,) in connection.execute("SELECT bitcode FROM cache")]
        connection.close()

    print("expected  one piece of code, compiled by the first of three processes")
    print(f"got       {len(keys)}, of {', '.join(str(len(key)) for key in keys)} bytes of bitcode")
    if len(keys) > 1:
        differing = [i for i, (a, b) in enumerate(zip(*keys[:2], strict=False)) if a != b]
        print(
            f"          the first two differ in {len(differing)} of them, from byte {differing[0]}"
        )
    sys.exit(1 if len(keys) > 1 else 0)
