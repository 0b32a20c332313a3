"""Checks of output files and folders, before anything is asked, planned or driven.

Options that name an output have one of these functions as their ``callback``, which typer calls while it parses the
command line. The checks leave no files behind.
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
    """Check an option that names a file, which is replaced if it exists.

    Raises:
        OutputError: The file cannot be written, or another option names the same one.
    """
    if path == STANDARD:
        _take_standard_output(ctx, param)
    elif path is not None:
        _require_file(path, f"{_name(param)} {path}")
        _require_own(ctx, param, path)
    return path


def to_whole_file(ctx: typer.Context, param: typer.CallbackParam, path: Path | None) -> Path | None:
    """Check an option that names a file which is written atomically.

    Raises:
        OutputError: As for :func:`to_file`.
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
    """Check an option that names a file, but not standard output: it is read again, or its suffix is its format.

    Raises:
        OutputError: As for :func:`to_file`, or it is standard output.
    """
    if path is not None:
        refuse_standard_output(path, _name(param))
    return to_file(ctx, param, path)


def to_picture(ctx: typer.Context, param: typer.CallbackParam, path: Path | None) -> Path | None:
    """Check an option that names a picture.

    Raises:
        OutputError: As for :func:`to_file`, or the suffix is not a picture format.
    """
    if path is not None:
        from fieldhand.site.drawing.saving import require_picture

        refuse_standard_output(path, _name(param))
        to_file(ctx, param, path)
        require_picture(path)
    return path


def to_folder(ctx: typer.Context, param: typer.CallbackParam, path: Path | None) -> Path | None:
    """Check an option that names the output folder of a mission, whose files are replaced.

    Raises:
        OutputError: A file cannot be written, or another option names the same folder.
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
    """Return the files of a mission in its output folder: Task, map, events and report."""
    from fieldhand.evaluation.report.writing import ReportFiles

    return (*(folder / name for name in ("task.xml", "map.png", "events.jsonl")), *ReportFiles.within(folder).paths)


def require_folder(path: Path, where: str) -> None:
    """Require that files can be written to a folder, or that it can be made.

    Args:
        path: The folder.
        where: Name of the option and the folder, for messages.

    Raises:
        OutputError: It is a file, or cannot be written or made.
    """
    try:
        folder = Path(os.path.realpath(path))
        there = next(f for f in (folder, *folder.parents) if f.exists())
        if not there.is_dir():
            what = message("cannot write: {name} is a file, not a folder", name=there.name)
            raise OutputError(what, where=where, advice=message("choose a folder that you may write to"))
        with tempfile.TemporaryFile(dir=there):  # permissions alone are not conclusive on every system
            pass
    except OSError as error:
        raise unwritable(where, error) from None


def unwritable(where: str, error: OSError) -> OutputError:
    """Return the error for a path that cannot be written."""
    return OutputError(
        message("cannot write: {why}", why=named(error.strerror or str(error), "reason")),
        where=where,
        advice=message("choose a folder that you may write to"),
    )


def _take_standard_output(ctx: typer.Context, param: typer.CallbackParam) -> None:
    """Reserve standard output for one file, and print messages on standard error while the command runs.

    Raises:
        OutputError: Another option or ``--json`` uses standard output, too.
    """
    from fieldhand.cli.console import out

    option = _name(param)
    other = "--json" if "--json" in sys.argv else ctx.meta.setdefault(_OPTIONS, {}).setdefault(str(STANDARD), option)
    if other != option:
        raise OutputError(
            message("both {other} and {option} write to standard output", other=other, option=option),
            advice=message("give a file name for one of them"),
        )
    out.stderr = True
    ctx.call_on_close(lambda: setattr(out, "stderr", False))


def refuse_standard_output(path: Path | None, option: str) -> None:
    """Require that an output is not ``-``: it is a folder, a picture, or read again.

    Raises:
        OutputError: It is ``-``.
    """
    if path == STANDARD:
        raise OutputError(
            message("cannot be written to standard output"), where=f"{option} -", advice=message("give a file name")
        )


def _require_file(path: Path, where: str) -> None:
    try:
        _require_no_folder(path, where)
        if path.is_file():
            with path.open("ab"):
                pass
        elif not path.exists():
            require_folder(Path(os.path.realpath(path)).parent, where)
        elif not os.access(path, os.W_OK):  # opening a pipe or a device may block
            raise PermissionError(13, "Permission denied")
    except OSError as error:
        raise unwritable(where, error) from None


def _require_no_folder(path: Path, where: str) -> None:
    if path.is_dir():
        raise OutputError(
            message("is a folder, not a file"), where=where, advice=message("give the name of a file in it")
        )


def _require_own(ctx: typer.Context, param: typer.CallbackParam, path: Path) -> None:
    """Require that no other option names the same path, as one would overwrite the other.

    Raises:
        OutputError: One does.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        return  # a device may be given twice
    option = _name(param)
    other = ctx.meta.setdefault(_OPTIONS, {}).setdefault(os.path.realpath(path), option)
    if other != option:
        raise OutputError(
            message("is given for both {other} and {option}", other=other, option=option),
            where=str(path),
            advice=message("give each its own file"),
        )


def _name(param: typer.CallbackParam) -> str:
    """Return the long name of an option."""
    return max(param.opts, key=len)
