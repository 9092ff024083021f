"""Modules that can be called: `taylor_verify.run` and `taylor_verify.exact` are rooms and functions of one name."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import ModuleType
from typing import Any


def make_callable(name: str, function: Callable[..., Any]) -> None:
    """Let the module of that name be called as the function."""

    class CallableModule(ModuleType):
        __doc__ = function.__doc__

        def __call__(self, *arguments: Any, **keywords: Any) -> Any:
            return function(*arguments, **keywords)

    sys.modules[name].__class__ = CallableModule
