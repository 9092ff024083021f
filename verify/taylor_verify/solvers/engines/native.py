"""Environments of engines in C++: libraries of Debian, as apt-get downloads them, and a compiler.

The packages are unpacked into a folder of the user's cache, where they need no rights, and
`with_NAME.cpp` is compiled there to a library. solvers/outside/native.py loads it and answers. `flags` in
the metadata are those of the compiler, with {root} in the place of the unpacked packages.
"""

from __future__ import annotations

import hashlib
import re
import shutil
import sys
import tomllib
from pathlib import Path
from typing import Final, final

from taylor_verify.solvers.engines.launcher import Launcher, NotMade, Tell, made_once, output
from taylor_verify.solvers.solver import Lack
from taylor_verify.solvers.trajectory import Outcome

_DRIVER: Final = Path(__file__).parents[1] / "outside" / "native.py"
_LIBRARY: Final = "engine.so"
_COMPILER: Final = "g++"


@final
class Native(Launcher):
    """Scripts with_NAME.cpp, their packages from Debian."""

    comment = "//"
    pin = "="
    pinned = re.compile(r"([a-z0-9][a-z0-9.+-]*)=\d[0-9A-Za-z.+~:-]*")
    version = re.compile(r"\d[0-9A-Za-z.+~:-]*")

    def unavailable(self) -> str:
        for program in ("apt-get", "dpkg-deb", _COMPILER):
            if not shutil.which(program):
                sentence = f"{program} is not installed: it takes Debian or a descendant, with g++"
                return Lack(sentence, Outcome.NO_PACKAGE)
        return ""

    def command(self, name: str, script: Path, block: str, tell: Tell) -> list[str]:
        try:
            library = _compiled(name, script, block, tell)
        except OSError as error:
            raise NotMade(f"{error.filename or name}: {error.strerror or error}") from None
        return [sys.executable, "-B", "-E", "-s", str(_DRIVER), str(library)]


def _compiled(name: str, script: Path, block: str, tell: Tell) -> Path:
    """Return the library of an engine, which is made if it is not there."""
    made_of = script.read_bytes() + block.encode()
    digest, metadata = hashlib.sha256(made_of).hexdigest()[:12], tomllib.loads(block)

    def make(made: Path, place: Path) -> None:
        tell(f"making the environment of {name}, once: a download and a compilation")
        root = made / "root"
        root.mkdir()
        _unpack(metadata.get("dependencies", []), made, root)
        _compile(script, metadata["tool"]["taylor-verify"].get("flags", ""), made, place)

    place = made_once(f"{name}-{digest}", lambda place: (place / _LIBRARY).exists(), make)
    return place / _LIBRARY


def _unpack(packages: list[str], made: Path, root: Path) -> None:
    """Download packages of Debian and unpack them below ``root``."""
    if packages:
        output(["apt-get", "download", "-qq", *packages], made)
    for package in sorted(made.glob("*.deb")):
        output(["dpkg-deb", "-x", package.name, str(root)], made)
        package.unlink()


def _compile(script: Path, flags: str, made: Path, place: Path) -> None:
    """Compile a script to a library that finds its own ones at their last ``place``."""
    words = [
        _COMPILER,
        "-O2",
        "-fPIC",
        "-shared",
        "-I{root}/usr/include",
        str(script),
        *flags.split(),
    ]
    for folder in sorted((made / "root/usr/lib").glob("*-linux-*")):
        inside = folder.relative_to(made)
        # Libraries of libraries are looked for by the older of the two tags alone.
        words += [f"-L{folder}", f"-Wl,--disable-new-dtags,-rpath,{place / inside}"]
    rooted = [word.replace("{root}", str(made / "root")) for word in words]
    output([*rooted, "-o", str(made / _LIBRARY)], made)
