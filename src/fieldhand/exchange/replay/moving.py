"""Replay as an animation: GIF, or MP4 if ffmpeg is installed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fieldhand.clock import clock_time
from fieldhand.errors import OutputError
from fieldhand.exchange.replay.film import Film, ReplayCapture
from fieldhand.hidden_characters import visible
from fieldhand.language.words import capitalised, say_name, say_unit
from fieldhand.site.drawing import draw_site, name_site, site_figure
from fieldhand.site.drawing.colours import FAILED, INK, PATH
from fieldhand.site.drawing.saving import make_text_visible
from fieldhand.site.model import Site

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PLAIN, _SIGN = "#6a3d9a", "#8a3b00"
#: Maximum length in characters of the latest log line below the map.
_LONGEST = 70
_FRAMES_A_SECOND = 10
#: Height of the image in inches, dots per inch, and duration of the last image in seconds.
_HEIGHT_IN, _DPI, _HOLD_S = 6.0, 80, 1.5


def save_animation(film: Film, site: Site, path: Path, *, seconds: float = 10.0) -> None:
    """Write a replay as an animation; the extension selects the format, ``.gif`` or ``.mp4``.

    Args:
        film: Replay to draw.
        site: Site of the mission.
        path: Output file; its folder is created.
        seconds: Duration of the animation, independent of the mission's duration.

    Raises:
        OutputError: The file cannot be written, or MP4 is requested without ffmpeg.
    """
    import matplotlib.animation as animation

    if path.suffix.lower() == ".mp4" and not animation.FFMpegWriter.isAvailable():
        what = "an MP4 needs the program ffmpeg, which is not installed"
        raise OutputError(what, where=str(path), advice="install ffmpeg, or use a file name that ends in .gif or .html")
    kind = animation.FFMpegWriter if path.suffix.lower() == ".mp4" else animation.PillowWriter
    frames = _MovingScene(film, site)
    writer = kind(fps=_FRAMES_A_SECOND)
    times = np.linspace(0.0, film.seconds, max(2, round(seconds * _FRAMES_A_SECOND)))
    times = np.append(times, [film.seconds] * round(_HOLD_S * _FRAMES_A_SECOND))
    sheet, image = _sheet(frames.at(0.0))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with writer.saving(sheet, str(path), _DPI):
            for t in times:
                image.set_data(frames.at(float(t)))
                writer.grab_frame()
    except OSError as fault:
        what = f"the animation cannot be written ({fault.strerror or fault})"
        raise OutputError(what, where=str(path), advice="choose another place") from None


def _sheet(picture: NDArray[np.uint8]) -> tuple[Figure, Any]:
    """Return a figure that contains only an image, and that image, for fast repeated writing."""
    from matplotlib.figure import Figure

    high, wide = picture.shape[:2]
    figure = Figure(figsize=(wide / _DPI, high / _DPI), dpi=_DPI)
    _canvas(figure)
    return figure, figure.figimage(picture)


class _MovingScene:
    """The static site and the moving marks drawn on it."""

    def __init__(self, film: Film, site: Site) -> None:
        from matplotlib.collections import PolyCollection

        self._film = film
        figure = site_figure(site)
        width, height = figure.get_size_inches()
        figure.set_dpi(_DPI)
        figure.set_size_inches(_even(width / height * _HEIGHT_IN + 1.2), _even(_HEIGHT_IN))
        self._ax = ax = figure.axes[0]
        draw_site(ax, site)
        layout = figure.get_layout_engine()
        low = 0.04 if film.signs else 0.0
        if layout is not None:
            layout.set(rect=(0.0, low, 1.0, 0.91 - low))  # type: ignore[call-arg]  # a constrained one
        figure.text(0.02, 0.985, film.title, ha="left", va="top", fontsize=11, color=INK)
        self._clock = figure.text(0.02, 0.915, "", ha="left", va="bottom", fontsize=10, color=INK)
        self._aside = 0.03 * float(np.ptp(ax.get_xlim()))
        quantity = film.quantities[0] if film.quantities else ""
        self._valued = [c for c in film.captures if quantity in c.readings]
        self._values = np.array([c.readings[quantity] for c in self._valued])
        self._others = [c for c in film.captures if c.good and quantity not in c.readings]
        (self._way,) = ax.plot([], [], color=PATH, linewidth=1.8, alpha=0.8)
        (self._robot,) = ax.plot([], [], "o", color=PATH, markersize=9, markeredgecolor="white", markeredgewidth=1.5)
        (self._plain,) = ax.plot([], [], "D", color=_PLAIN, markersize=6, markeredgecolor="white")
        (self._failed,) = ax.plot([], [], "X", color=FAILED, markersize=8, markeredgecolor="white")
        self._dots = _valued_dots(figure, ax, self._valued, quantity) if self._valued else None
        self._closed = PolyCollection([], facecolors="#b3261e55", edgecolors=FAILED, linewidths=1.2, zorder=9)
        ax.add_collection(self._closed, autolim=False)
        self._flags = {
            mark: ax.plot([], [], marker=f"$\\mathbf{{{mark}}}$", color=_SIGN, linestyle="none", markersize=10)[0]
            for mark in dict.fromkeys(sign.mark for sign in film.signs)
        }
        self._news = figure.text(0.02, 0.015, "", ha="left", va="bottom", fontsize=9, color=_SIGN)
        moving = (self._closed, self._way, self._plain, self._failed, self._dots, *self._flags.values(), self._robot)
        self._moving = [artist for artist in (*moving, self._clock, self._news) if artist is not None]
        for artist in self._moving:
            artist.set_animated(True)
        make_text_visible(figure)
        figure.draw_without_rendering()  # so that title and scale have taken their room
        figure.set_layout_engine("none")
        name_site(ax, site)
        make_text_visible(figure)
        self._canvas = _canvas(figure)
        self._canvas.draw()
        self._background = self._canvas.copy_from_bbox(figure.bbox)

    def at(self, t: float) -> NDArray[np.uint8]:
        """Return the image at a time, shape (height, width, 4)."""
        film = self._film
        driven = film.until(t)
        self._way.set_data(driven[:, 0], driven[:, 1])
        self._robot.set_data(driven[-1:, 0], driven[-1:, 1])
        done = [c for c in self._valued if c.t <= t]
        if self._dots is not None:
            self._dots.set_offsets(_xy(done))
            self._dots.set_array(self._values[: len(done)])
        self._plain.set_data(*_xy([c for c in self._others if c.t <= t]).T)
        self._failed.set_data(*_xy([c for c in film.captures if not c.good and c.t <= t]).T)
        self._closed.set_verts(film.blocked_at(t))
        signs = [sign for sign in film.signs if sign.t <= t]
        for mark, flag in self._flags.items():
            # Draw signs beside the robot instead of under it.
            mine = [sign for sign in signs if sign.mark == mark]
            flag.set_data([s.x + (1 + s.beside) * self._aside for s in mine], [s.y for s in mine])
        news = visible(signs[-1].words) if signs else ""
        self._news.set_text(news if len(news) <= _LONGEST else f"{news[: _LONGEST - 1]}\u2026")
        made = sum(c.good and c.t <= t for c in film.captures)
        count = f"{made} capture{'s' * (made != 1)}"
        self._clock.set_text(f"{clock_time(t)}   battery {film.charge_at(t):.0f} %   {count}")
        self._canvas.restore_region(self._background)
        for artist in self._moving:
            self._ax.draw_artist(artist)
        return np.array(self._canvas.buffer_rgba())


def _canvas(figure: Figure) -> Any:
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    return FigureCanvasAgg(figure)


def _valued_dots(figure: Figure, ax: Axes, valued: list[ReplayCapture], quantity: str) -> Any:
    """Draw dots coloured by value, with a colour bar for the range of the whole mission."""
    values = [c.readings[quantity] for c in valued]
    low, high = min(values), max(values)
    if high - low < 1e-9:
        low, high = low - 0.5, high + 0.5
    dots = ax.scatter(
        [], [], c=[], cmap="viridis", vmin=low, vmax=high, s=95, edgecolors="white", linewidths=1.2, zorder=13
    )
    bar = figure.colorbar(dots, ax=ax, shrink=0.6, pad=0.02)
    unit = next((c.units[quantity] for c in valued if quantity in c.units), "")
    bar.set_label(f"{capitalised(say_name(quantity))} [{say_unit(unit)}]" if unit else capitalised(say_name(quantity)))
    return dots


def _xy(captures: list[ReplayCapture]) -> Any:
    return np.array([(c.x, c.y) for c in captures], dtype=np.float64).reshape(-1, 2)


def _even(inches: float) -> float:
    """Return a length in inches that gives an even number of dots, as video codecs require."""
    return 2 * round(inches * _DPI / 2) / _DPI
