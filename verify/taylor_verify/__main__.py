"""``python -m taylor_verify``: the same command as ``taylor-verify``."""

from taylor_verify.cli import main

raise SystemExit(main())
