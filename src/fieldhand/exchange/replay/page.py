"""Replay as one self-contained HTML page without network access or external scripts; log content stays text."""

from __future__ import annotations

import base64
import hashlib
import html
from importlib.resources import files
from typing import Any

import numpy as np

from fieldhand.exchange.replay.film import SIGNS, Film
from fieldhand.hidden_characters import visible, visible_json
from fieldhand.language.words import capitalised, say_action, say_name, say_unit
from fieldhand.site.drawing.blocks import block_words, outline_of
from fieldhand.site.model import Site


def page_of(film: Film, site: Site) -> bytes:
    """Return the page in UTF-8."""
    here = files("fieldhand.exchange.replay")
    script = (here / "page.js").read_text(encoding="utf-8")
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{digest}'"
    # Inside a script element only "<" could end it.
    data = visible_json(_data(film, site), separators=(",", ":")).replace("<", "\\u003c")
    page = (here / "page.html").read_text(encoding="utf-8")
    parts = {
        "policy": policy,
        "title": html.escape(visible(film.title)),
        "style": (here / "page.css").read_text(encoding="utf-8"),
        "data": data,
        "script": script,
    }
    return "".join(parts.get(piece, piece) for piece in page.split("@@")).encode()


def _data(film: Film, site: Site) -> dict[str, Any]:
    return {
        "seconds": round(film.seconds, 2),
        "track": _rounded(film.track),
        "charge": _rounded(film.charge),
        "trees": _rounded(site.xy),
        "zones": [
            {"kind": zone.kind, "name": zone.name, "ring": _rounded(np.asarray(zone.polygon.exterior.coords)[:, :2])}
            for zone in site.zones
        ],
        "blocks": _blocks(site),
        "markers": [{"name": name, "x": round(p.x, 2), "y": round(p.y, 2)} for name, p in site.markers.items()],
        "captures": [
            {
                "t": round(c.t, 2),
                "x": round(c.x, 2),
                "y": round(c.y, 2),
                "place": c.place,
                "what": capitalised(say_action(c.action)),
                "good": c.good,
                "readings": dict(c.readings),
            }
            for c in film.captures
        ],
        "quantities": [{"key": q, "name": capitalised(say_name(q)), "unit": _unit(film, q)} for q in film.quantities],
        "lines": [[round(t, 2), text] for t, text in film.lines],
        "signs": [
            {
                "t": round(s.t, 2),
                "x": round(s.x, 2),
                "y": round(s.y, 2),
                "mark": s.mark,
                "beside": s.beside,
                "blocked": None if s.blocked is None else [_rounded(area) for area in s.blocked],
            }
            for s in film.signs
        ],
        "meanings": [[mark, words] for mark, words in SIGNS.values() if any(s.mark == mark for s in film.signs)],
        "spacing": round(site.spacing_m, 2),
    }


def _blocks(site: Site) -> list[dict[str, Any]]:
    """Return the outline of each block with its name, where there are several."""
    blocks = site.planting.blocks if len(site.planting.blocks) > 1 else ()
    return [
        {"name": block_words(block), "ring": _rounded(np.asarray(outline_of(site, block).exterior.coords)[:, :2])}
        for block in blocks
    ]


def _unit(film: Film, quantity: str) -> str:
    return say_unit(next((c.units[quantity] for c in film.captures if quantity in c.units), ""))


def _rounded(rows: Any) -> list[list[float]]:
    """Return the rows rounded to centimetres."""
    found: list[list[float]] = np.round(np.asarray(rows, dtype=np.float64), 2).tolist()
    return found
