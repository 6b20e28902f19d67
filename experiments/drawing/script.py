"""The command line that all scripts share: files in, files out. Bad input is one line on standard error and exit code 2, a full disk
one and exit code 1."""

import argparse
import contextlib
import errno
import inspect
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from hagfish_log import LogError

# The program as built.
HAGFISH = Path(os.environ.get("HAGFISH_PROGRAM", Path(__file__).resolve().parents[2] / "build/release/experiments/hagfish"))


def run_script(description: str | None, names: Sequence[str], work: Callable[..., None]) -> None:
    """Runs `work` on a command line of so many files and folders, or of numbers and words where it says so. A name with a suffix, such as
    LOG.h5, asks its argument to have it too."""
    parser = argparse.ArgumentParser(description=description)
    kinds = [of.annotation for of in inspect.signature(work).parameters.values()]
    for name, kind in zip(names, kinds, strict=True):
        parser.add_argument(name, type=kind if kind in (int, float, str) else Path)
    given = list(vars(parser.parse_args()).values())
    for name, argument in zip(names, given):
        if Path(name).suffix and Path(argument).suffix != Path(name).suffix:
            parser.error(f"{argument}: {name} must end in {Path(name).suffix}")
    try:
        work(*given)
    except LogError as error:
        fail(str(error))
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
        fail(f"{error.filename}: {error.strerror}" if error.filename else str(error), 1 if full else 2)


def printable(text: str) -> str:
    """Without what a terminal would obey."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "surrogatepass").decode() for c in text)


@contextlib.contextmanager
def whole(file: Path) -> Iterator[Path]:
    """A file to write, which has the name of `file` only when it is whole. What fails names `file`."""
    part = file.with_name(f"{file.stem}.part{file.suffix}")
    try:
        yield part
        part.replace(file)
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(file)) from error
    finally:
        part.unlink(missing_ok=True)


def fail(message: str, code: int = 2) -> None:
    print(printable(f"{Path(sys.argv[0]).name}: {message}"), file=sys.stderr)
    sys.exit(code)
