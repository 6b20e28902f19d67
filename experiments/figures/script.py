"""The command line that all scripts share: files in, files out. Bad input is one line on standard error and exit code 2."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from hagfish_log import LogError


def run_script(description: str | None, names: Sequence[str], work: Callable[..., None]) -> None:
    """Runs `work(path, ...)` on a command line of so many files and folders. A name with a suffix, such as LOG.h5, asks its
    argument to have it too."""
    parser = argparse.ArgumentParser(description=description)
    for name in names:
        parser.add_argument(name, type=Path)
    paths = list(vars(parser.parse_args()).values())
    for name, path in zip(names, paths):
        if Path(name).suffix and path.suffix != Path(name).suffix:
            parser.error(f"{path}: {name} must end in {Path(name).suffix}")
    try:
        work(*paths)
    except LogError as error:
        fail(str(error))
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}" if error.filename else str(error))


def printable(text: str) -> str:
    """Without what a terminal would obey."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "surrogatepass").decode() for c in text)


def fail(message: str) -> None:
    print(printable(f"{Path(sys.argv[0]).name}: {message}"), file=sys.stderr)
    sys.exit(2)
