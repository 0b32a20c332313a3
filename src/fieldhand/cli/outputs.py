"""Where commands write: whether they can is found out before anything is asked, planned or driven.

Options that name a file or a folder to write have a function of here for their ``callback``: it is called while the
command line is read. It tries, and leaves nothing behind.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import typer

from fieldhand.errors import OutputError
from fieldhand.files import STANDARD
from fieldhand.language import message, named

_OPTIONS = "fieldhand.outputs"


def to_file(ctx: typer.Context, param: typer.CallbackParam, path: Path | None) -> Path | None:
    """Of an option that names a file; one that is there is replaced.

    Raises:
        OutputError: It cannot be written, or another option names the same.
    """
    if path == STANDARD:
        _take_standard_output(ctx, param)
    elif path is not None:
        _require_file(path, f"{_name(param)} {path}")
        _require_own(ctx, param, path)
    return path


def to_whole_file(ctx: typer.Context, param: typer.CallbackParam, path: Path | None) -> Path | None:
    """Of an option that names a file which is written beside its place and then put there, as a whole or not at all.

    Standard output gets it as a whole.

    Raises:
        OutputError: As :func:`to_file`.
    """
    if path == STANDARD:
        _take_standard_output(ctx, param)
    elif path is not None:
        where = f"{_name(param)} {path}"
        require_folder(path.parent, where)
        _require_no_folder(path, where)
        _require_own(ctx, param, path)
    return path


def to_named_file(ctx: typer.Context, param: typer.CallbackParam, path: Path | None) -> Path | None:
    """Refuse standard output for a file that is read again, or whose suffix names its kind.

    Raises:
        OutputError: As :func:`to_file`, or it is standard output.
    """
    if path is not None:
        refuse_standard_output(path, _name(param))
    return to_file(ctx, param, path)


def to_picture(ctx: typer.Context, param: typer.CallbackParam, path: Path | None) -> Path | None:
    """Of an option that names a picture.

    Raises:
        OutputError: As :func:`to_file`, or its ending is of no kind of picture.
    """
    if path is not None:
        from fieldhand.site.drawing.saving import require_picture

        refuse_standard_output(path, _name(param))
        to_file(ctx, param, path)
        require_picture(path)
    return path


def to_folder(ctx: typer.Context, param: typer.CallbackParam, path: Path | None) -> Path | None:
    """Of an option that names the folder of what a mission leaves behind; what is there of the same names is replaced.

    Raises:
        OutputError: It cannot be written, or another option names the same.
    """
    if path is not None:
        refuse_standard_output(path, _name(param))
        require_folder(path, f"{_name(param)} {path}")
        for file in mission_files(path):
            if file.exists():
                _require_file(file, f"{_name(param)} {file}")
        _require_own(ctx, param, path)
    return path


def mission_files(folder: Path) -> tuple[Path, ...]:
    """What a mission leaves behind in a folder: Task, map, events, and the report, its page first."""
    from fieldhand.evaluation.report.writing import ReportFiles

    return (*(folder / name for name in ("task.xml", "map.png", "events.jsonl")), *ReportFiles.within(folder).paths)


def require_folder(path: Path, where: str) -> None:
    """Refuse a folder in which nothing can be written; one that is not there yet is made later.

    Args:
        where: What to call it.

    Raises:
        OutputError: It is a file, or may not be written or made.
    """
    try:
        folder = Path(os.path.realpath(path))
        there = next(f for f in (folder, *folder.parents) if f.exists())
        if not there.is_dir():
            what = message("cannot write: {name} is a file, not a folder", name=there.name)
            raise OutputError(what, where=where, advice=message("choose a folder that you may write to"))
        with tempfile.TemporaryFile(dir=there):  # rights alone do not say it on every system
            pass
    except OSError as error:
        raise unwritable(where, error) from None


def unwritable(where: str, error: OSError) -> OutputError:
    """What is said of what cannot be written."""
    return OutputError(
        message("cannot write: {why}", why=named(error.strerror or str(error), "reason")),
        where=where,
        advice=message("choose a folder that you may write to"),
    )


def _take_standard_output(ctx: typer.Context, param: typer.CallbackParam) -> None:
    """Keep standard output for one file: whatever people read goes to standard error for as long as the command runs.

    Raises:
        OutputError: Another option, or the one JSON object, goes there as well.
    """
    from fieldhand.cli.console import out

    option = _name(param)
    other = "--json" if "--json" in sys.argv else ctx.meta.setdefault(_OPTIONS, {}).setdefault(str(STANDARD), option)
    if other != option:
        raise OutputError(
            message("standard output is asked for by {other} and by {option}", other=other, option=option),
            advice=message("name a file for one"),
        )
    out.stderr = True
    ctx.call_on_close(lambda: setattr(out, "stderr", False))


def refuse_standard_output(path: Path | None, option: str) -> None:
    """Refuse ``-`` for what is a folder, a picture, or read again.

    Raises:
        OutputError: It is standard output.
    """
    if path == STANDARD:
        raise OutputError(
            message("cannot go to standard output"), where=f"{option} -", advice=message("give it a name")
        )


def _require_file(path: Path, where: str) -> None:
    try:
        _require_no_folder(path, where)
        if path.is_file():
            with path.open("ab"):
                pass
        elif not path.exists():
            require_folder(Path(os.path.realpath(path)).parent, where)
        elif not os.access(path, os.W_OK):  # a pipe or a device, which may wait for its reader when it is opened
            raise PermissionError(13, "Permission denied")
    except OSError as error:
        raise unwritable(where, error) from None


def _require_no_folder(path: Path, where: str) -> None:
    if path.is_dir():
        raise OutputError(
            message("is a folder, not a file"), where=where, advice=message("give the name of a file in it")
        )


def _require_own(ctx: typer.Context, param: typer.CallbackParam, path: Path) -> None:
    """Refuse what another option names as well: the one would overwrite the other.

    Raises:
        OutputError: It does.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        return  # a device takes whatever it is given
    option = _name(param)
    other = ctx.meta.setdefault(_OPTIONS, {}).setdefault(os.path.realpath(path), option)
    if other != option:
        raise OutputError(
            message("is given for {other} and for {option}", other=other, option=option),
            where=str(path),
            advice=message("give each its own"),
        )


def _name(param: typer.CallbackParam) -> str:
    """An option by its long name."""
    return max(param.opts, key=len)
