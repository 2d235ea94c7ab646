"""Temporary folders of results: those of a process lie in a folder of its own, with a lock that lives as long as it.

A process that is killed leaves its folder; the next process that needs one removes it.
"""

import os
import shutil
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import IO

if sys.platform != "win32":
    import fcntl

_PREFIX = "enmm-"
_LOCK = "lock"
_YOUNG = 60.0
"""Age of a lock (s) below which its process may be about to take it."""


class _Home:
    """The folder of this process."""

    def __init__(self) -> None:
        self.path = Path(tempfile.mkdtemp(prefix=_PREFIX))
        self.pid = os.getpid()
        self.lock = (self.path / _LOCK).open("w")
        _take(self.lock)

    def remove(self) -> None:
        self.lock.close()
        shutil.rmtree(self.path, ignore_errors=True)


_guard = threading.Lock()
_home: _Home | None = None
_swept = False


def make() -> Path:
    """Makes a folder."""
    global _home, _swept
    with _guard:
        if not _swept:
            _swept = True
            _sweep(Path(tempfile.gettempdir()))
        if _home is None:
            _home = _Home()
        return Path(tempfile.mkdtemp(dir=_home.path, prefix=""))


def remove(folder: Path) -> None:
    """Removes a folder that this process made; with its last one that of the process goes."""
    global _home
    with _guard:
        # A forked process has the objects of its parent, but not their folders.
        if _home is None or folder.parent != _home.path:
            return
        shutil.rmtree(folder, ignore_errors=True)
        if all(name == _LOCK for name in os.listdir(_home.path)):
            _home.remove()
            _home = None


def _sweep(folder: Path) -> None:
    """Removes what processes left that are no more."""
    with os.scandir(folder) as entries:
        there = [entry for entry in entries if entry.name.startswith(_PREFIX) and entry.is_dir(follow_symlinks=False)]
    for entry in there:
        if sys.platform != "win32" and entry.stat(follow_symlinks=False).st_uid != os.getuid():
            continue
        if _is_left(Path(entry.path) / _LOCK):
            shutil.rmtree(entry.path, ignore_errors=True)


def _is_left(lock: Path) -> bool:
    """Whether nobody holds a lock."""
    try:
        if time.time() - lock.stat().st_mtime < _YOUNG:
            return False
        if sys.platform == "win32":
            lock.unlink()  # Refused while a process has it open.
            return True
        with lock.open("r+") as file:
            return _take(file)
    except OSError:
        return False


def _take(lock: IO[str]) -> bool:
    """Takes a lock until its file is closed; false when another process has it."""
    if sys.platform == "win32":
        return True
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _forget() -> None:
    """Begins again in a forked process, whose parent keeps its folder and its lock."""
    global _guard, _home
    _guard = threading.Lock()
    if _home is not None:
        _home.lock.close()
        _home = None


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)
