"""Classify the features of a site file by their properties: trees, markers, landmarks, kinds of areas.

Programs name the property differently (``marker-symbol``, ``kind``, ``type``); names are compared ignoring case,
hyphens, underscores and spaces. A point without another kind is a tree.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from functools import lru_cache
from typing import Literal

from fieldhand.terms import Value

ZoneKind = Literal["boundary", "keep_out", "zone"]
PointKind = Literal["tree", "start", "end", "charger", "gate", "landmark"]

KIND_KEYS = ("marker symbol", "kind", "type", "symbol", "class", "feature type", "category", "role")
NAME_KEYS = ("name", "title", "label")
ROW_KEYS = ("row", "row id", "row number", "row no", "row num", "row name")
BLOCK_KEYS = (
    *("block", "block id", "block number", "block no", "block name", "plot", "plot id", "plot number", "plot name"),
    *("parcel", "parcel id", "parcel name", "section", "section id", "section name", "paddock", "quarter"),
)
#: A column is the position in the row if the file names rows as well, else it is the row.
COLUMN_KEYS = ("column", "col", "column id", "column number", "column no", "col no", "line", "line id", "line number")
POSITION_KEYS = (
    *("position", "pos", "position in row", "row position", "place in row", "tree in row", "tree number", "tree no"),
    *(
        "tree position",
        "number in row",
        "tree num",
        "plant number",
        "plant no",
        "vine number",
        "vine no",
        "slot",
        "tree index",
    ),
)

MARKERS: Mapping[str, PointKind] = {
    **dict.fromkeys(
        ("start", "start point", "starting point", "start marker", "begin", "home", "depot", "base"), "start"
    ),
    **dict.fromkeys(("end", "end point", "ending point", "end marker", "finish", "finish point", "goal"), "end"),
    **dict.fromkeys(
        (
            *("charger", "charge", "charging", "charging station", "charging point", "charge point", "charge station"),
            *("dock", "dock station", "docking station", "charger marker"),
        ),
        "charger",
    ),
}

# fmt: off
#: A kind that contains one of these words is a plant ("pole bean plant", "tree by the gate").
PLANTS = frozenset({
    "tree", "trees", "vine", "vines", "plant", "plants", "bush", "shrub", "palm", "seedling", "sapling",
})

#: A kind that ends in one of these words is an opening in a fence.
GATES = frozenset({"gate", "entrance", "door", "doorway"})

#: A kind that ends in one of these words is an object other than a tree.
LANDMARKS = frozenset({
    "well", "borehole", "pole", "post", "pylon", "pump", "valve", "hydrant", "tap",
    "outlet", "sprinkler", "sensor", "station", "probe", "camera", "antenna", "gateway", "trap", "sign", "barn",
    "shed", "house", "building", "office", "silo", "tank", "hive", "hives", "rock", "boulder", "stump", "parking",
    "crossing", "bridge", "landmark", "waypoint", "marker", "mast", "trough",
})

#: Landmarks that robots drive over.
OPEN_LANDMARKS = frozenset({"parking", "crossing", "bridge", "waypoint"})

#: A line whose kind ends in one of these words is a barrier that no robot crosses.
_BARRIERS = frozenset({
    "fence", "fencing", "wall", "hedge", "hedgerow", "railing", "rail", "railway", "barrier", "pipe", "pipeline",
    "drain", "trench", "dyke", "dike", "embankment", "cliff", "boundary", "border", "perimeter", "geofence",
    *("ditch", "canal", "creek", "stream", "river"),
})

_KEEP_OUT = frozenset({
    "keepout", "nogo", "obstacle", "obstacles", "obstruction", "exclusion", "excluded", "forbidden", "prohibited",
    "restricted", "hazard", "danger", "pond", "lake", "water", "reservoir", "basin", "ditch", "canal", "creek",
    "stream", "river", "swamp", "building", "barn", "shed", "house", "office", "silo", "tank", "well", "rock",
    "boulder", "pit", "hole",
})
# fmt: on
_KEEP_OUT_PHRASES = frozenset({"keep out", "no go", "no drive", "no entry", "off limits"})
_BOUNDARY = frozenset({"boundary", "boundaries", "fence", "perimeter", "geofence", "outline", "border"})
_BOUNDARY_KINDS = _BOUNDARY | {"field", "farm", "orchard", "vineyard", "property", "parcel", "site", "plot"}
_PLAIN_AREAS = frozenset({"zone", "area", "polygon", "region", "block", "section"})

#: Numbers of areas of one kind.
_NUMBER_KEYS = ("number", "no", "num", "nr", "bed", "bed number", "bed no", "plot number", "plot no", "id")

_SEPARATORS = re.compile(r"[\W_]+")


@lru_cache(maxsize=8192)
def phrase(text: str) -> str:
    """Return text as lower-case words with single spaces: ``Keep-Out_Zone`` becomes ``keep out zone``."""
    return _SEPARATORS.sub(" ", text).strip().lower()


def text_of(properties: Mapping[str, Value], keys: tuple[str, ...]) -> str:
    """Return the first of these properties that is a text or a number, as text; empty if there is none."""
    for key in _matching_names(tuple(properties), keys):
        value = properties[key]
        if isinstance(value, str) and value.strip():
            return value.strip()
        if isinstance(value, float) and not isinstance(value, bool):
            return number_text(value)
    return ""


@lru_cache(maxsize=4096)
def _matching_names(names: tuple[str, ...], keys: tuple[str, ...]) -> tuple[str, ...]:
    """Return the property names that match the keys, in the order of the keys.

    Cached, since the trees of a file have the same few sets of properties.
    """
    spelling = {phrase(name): name for name in names}
    return tuple(spelling[key] for key in keys if key in spelling)


def number_text(value: float) -> str:
    """Return a number as text, whole numbers without decimals: 3.0 is ``3``."""
    return str(int(value)) if math.isfinite(value) and value == int(value) else repr(value)


def point_kind(properties: Mapping[str, Value]) -> tuple[PointKind, str]:
    """Return the kind of a point, and the file's word for it (empty if there is none).

    A point without a kind is a marker if its *name* is exactly a marker word ("Start"), else a tree.
    """
    kind_text = text_of(properties, KIND_KEYS)
    words = phrase(kind_text)
    if not words:
        name = text_of(properties, NAME_KEYS)
        return MARKERS.get(phrase(name), "tree"), name
    if words in MARKERS:
        return MARKERS[words], kind_text
    split = words.split()
    if PLANTS.isdisjoint(split):
        if split[-1] in GATES:
            return "gate", kind_text
        if split[-1] in LANDMARKS:
            return "landmark", kind_text
    return "tree", kind_text


def area_kind(properties: Mapping[str, Value]) -> tuple[ZoneKind, str]:
    """Return the kind of an area and its name, else the word for its kind; empty if it has neither."""
    kind_text, name = text_of(properties, KIND_KEYS), text_of(properties, NAME_KEYS)
    flagged = any(value is True and _means_keep_out(phrase(key)) for key, value in properties.items())
    if flagged or _means_keep_out(phrase(kind_text)):
        return "keep_out", name or kind_text or "keep-out"
    words = phrase(kind_text).split()
    if words and (words[-1] in _BOUNDARY_KINDS or words[0] in _BOUNDARY):
        return "boundary", name or kind_text
    if words and words[-1] in _PLAIN_AREAS and len(words) == 1:
        words = []
    if not words and _means_keep_out(phrase(name)):
        return "keep_out", name
    if not words and not _BOUNDARY.isdisjoint(phrase(name).split()[-1:]):
        return "boundary", name
    return "zone", _zone_name(properties, kind_text, name)


def _zone_name(properties: Mapping[str, Value], kind_text: str, name: str) -> str:
    """Return the name of a zone; one that is only numbered is named by its kind and number ("bed 4")."""
    number = name or text_of(properties, _NUMBER_KEYS)
    if kind_text and number.isdecimal():
        return f"{kind_text} {number}"
    return name or kind_text


def barrier_name(properties: Mapping[str, Value]) -> str:
    """Return the name of a line that no robot may cross (a fence, a ditch); empty for any other line."""
    kind_text, name = text_of(properties, KIND_KEYS), text_of(properties, NAME_KEYS)
    words = phrase(kind_text or name)
    if words.split()[-1:] and (words.split()[-1] in _BARRIERS or _means_keep_out(words)):
        return name or kind_text
    return ""


#: Lines that :mod:`fieldhand.site.formats.geojson_export` derives from the trees; reading them again adds
#: nothing.
DERIVED_LINES = frozenset({"row", "aisle", "headland", "gate", "link"})


def is_derived(properties: Mapping[str, Value]) -> bool:
    """Return True for a line that was derived from the trees, such as an exported row or aisle."""
    return phrase(text_of(properties, KIND_KEYS)) in DERIVED_LINES


def row_of(properties: Mapping[str, Value]) -> str:
    """Return the name of a tree's row; empty if the file gives none."""
    return text_of(properties, ROW_KEYS)


def _means_keep_out(words: str) -> bool:
    if not words:
        return False
    for ending in (" zone", " area", " region"):
        words = words.removesuffix(ending)
    return words in _KEEP_OUT_PHRASES or words.split()[-1] in _KEEP_OUT
