"""Export of a route as KML 2.2 (OGC 07-147r2), for Google Earth and GIS programs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.exchange.incidents import LatLon
from fieldhand.exchange.routes.route import ExportedRoute, RouteStop
from fieldhand.hidden_characters import visible
from fieldhand.language.words import capitalised, say_action, say_name, say_number, say_unit

if TYPE_CHECKING:
    from lxml.etree import _Element

NAMESPACE = "http://www.opengis.net/kml/2.2"
#: Colours in KML order: alpha, blue, green, red.
_STYLES = (("certain", "ff4f3226"), ("uncertain", "ff008bd4"), ("incident", "ff003b8a"))


def write_kml(route: ExportedRoute) -> bytes:
    """Return a document with folders of legs and stops, its elements in schema order."""
    from lxml import etree

    root = etree.Element(f"{{{NAMESPACE}}}kml", nsmap={None: NAMESPACE})  # type: ignore[dict-item]  # stubs forget None
    document = _sub(root, "Document")
    _sub(document, "name", route.name)
    for name, colour in _STYLES:
        style = _sub(document, "Style")
        style.set("id", name)
        line = _sub(style, "LineStyle")
        _sub(line, "color", colour)
        _sub(line, "width", "3")
    ways, stops = _sub(document, "Folder"), _sub(document, "Folder")
    _sub(ways, "name", "Ways")
    _sub(stops, "name", "Stops")
    for number, stop in enumerate(route.stops, start=1):
        if len(stop.way) > 1:
            mark = _placemark(ways, f"To stop {number}", f"{stop.length_m:.1f} m", _style(stop))
            line = _sub(mark, "LineString")
            _sub(line, "tessellate", "1")
            _sub(line, "coordinates", " ".join(_position(p) for p in stop.way))
        mark = _placemark(stops, f"{number}: {_named(stop)}", _described(stop), _style(stop))
        data = _sub(mark, "ExtendedData")
        for key, text in _data(route, stop, number).items():
            entry = _sub(data, "Data")
            entry.set("name", key)
            _sub(entry, "value", text)
        _sub(_sub(mark, "Point"), "coordinates", _position(stop.at))
    if route.incidents:
        happened = _sub(document, "Folder")
        _sub(happened, "name", "Incidents")
        for _, one in route.incidents:
            if one.at is not None:
                mark = _placemark(happened, one.event.replace("_", " "), one.words, "incident")
                data = _sub(mark, "ExtendedData")
                for key, text in {"t_s": f"{one.t:.3f}", "place": one.place, "node": one.node}.items():
                    entry = _sub(data, "Data")
                    entry.set("name", key)
                    _sub(entry, "value", text)
                _sub(_sub(mark, "Point"), "coordinates", _position(one.at))
    etree.indent(root)
    return etree.tostring(root, xml_declaration=True, encoding="UTF-8") + b"\n"


def _placemark(folder: _Element, name: str, about: str, style: str) -> _Element:
    mark = _sub(folder, "Placemark")
    _sub(mark, "name", name)
    if about:
        _sub(mark, "description", about)
    _sub(mark, "styleUrl", f"#{style}")
    return mark


def _style(stop: RouteStop) -> str:
    return "certain" if stop.certain else "uncertain"


def _named(stop: RouteStop) -> str:
    return f"tree {stop.place}" if stop.kind == "tree" else stop.place


def _described(stop: RouteStop) -> str:
    """Return the actions at a stop, one per line."""
    lines = []
    for work in stop.work:
        read = ", ".join(
            f"{say_name(q)} {say_number(v, 4)} {say_unit(u)}".strip() for q, (v, u) in work.readings.items()
        )
        failed = f", {work.failed} failed" if work.failed else ""
        lines.append(f"{capitalised(say_action(work.action))}: {work.captures}{failed}{'; ' + read if read else ''}")
    return "\n".join(lines)


def _data(route: ExportedRoute, stop: RouteStop, number: int) -> dict[str, str]:
    found = {"stop": str(number), "place": stop.place, "node": stop.node, "travelled_m": f"{stop.travelled_m:.3f}"}
    if stop.t is not None:
        found["t_s"] = f"{stop.t:.3f}"
    return found if route.driven else found | {"certain": "true" if stop.certain else "false"}


def _position(at: LatLon) -> str:
    return f"{at[1]:.9f},{at[0]:.9f}"


def _sub(parent: _Element, name: str, text: str = "") -> _Element:
    from lxml import etree

    made = etree.SubElement(parent, f"{{{NAMESPACE}}}{name}")
    if text:
        made.text = visible(text, lines=True)
    return made
