"""Pictures into files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.errors import OutputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def save_figure(figure: Figure, path: Path, *, what: str = "picture", make_folder: bool = False) -> None:
    """Write a figure; the ending of the path says as what kind of picture.

    Args:
        what: What it is called in an error.
        make_folder: Make its folder where there is none.

    Raises:
        OutputError: The file cannot be written, or its ending is of no kind of picture.
    """
    try:
        if make_folder:
            path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=150)
    except OSError as fault:
        raise OutputError(
            f"the {what} cannot be written ({fault.strerror or fault})", where=str(path), advice="choose another place"
        ) from None
    except ValueError:
        raise OutputError(
            f"{path.suffix or 'no ending'} is no kind of picture",
            where=str(path),
            advice="end its name in .png, .svg or .pdf",
        ) from None
