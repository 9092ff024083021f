"""``python -m verify``: the same command as ``taylor-verify``."""

from verify.cli import main

raise SystemExit(main())
