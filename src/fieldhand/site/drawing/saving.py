"""Save figures as picture files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.errors import OutputError
from fieldhand.hidden_characters import visible
from fieldhand.language import message

if TYPE_CHECKING:
    from matplotlib.figure import Figure


#: Extensions of the picture formats.
_KINDS = (".png", ".svg", ".pdf", ".jpg", ".jpeg")


_PICTURE = message("picture", context="file")


def save_figure(figure: Figure, path: Path, *, what: str = _PICTURE) -> None:
    """Write a figure and create its folder; the extension of the path selects the format.

    Args:
        figure: Figure to write.
        path: File to write.
        what: Name of the file in error messages.

    Raises:
        OutputError: The file cannot be written, or its extension is not that of a picture format.
    """
    require_picture(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        make_text_visible(figure)
        figure.savefig(path, dpi=150)
    except OSError as fault:
        raise OutputError(
            message("the {what} cannot be written ({why})", what=what, why=fault.strerror or str(fault)),
            where=str(path),
            advice=message("choose another place"),
        ) from None


def make_text_visible(figure: Figure) -> None:
    """Replace hidden characters in every text of a figure by their code points, and disable formulas.

    Call it before the figure is drawn or measured.
    """
    from matplotlib.text import Text

    for text in figure.findobj(Text):
        if isinstance(text, Text):
            text.set_text(visible(text.get_text(), lines=True))
            text.set_parse_math(False)


def require_picture(path: Path) -> None:
    """Check the extension of a picture file.

    Raises:
        OutputError: The extension is not that of a picture format.
    """
    if path.suffix.lower() not in _KINDS:
        raise OutputError(
            message(
                "{ending} is not a supported picture format",
                ending=path.suffix or message("a name without extension"),
            ),
            where=str(path),
            advice=message("use a file name that ends in .png, .svg or .pdf"),
        )
