"""Colours of the pictures of a site."""

from __future__ import annotations

TREE = "#5b8c5a"
#: Colours of neighbouring rows, distinguishable with colour blindness.
ROWS = ("#0072b2", "#e69f00", "#117a65", "#d55e00")
#: Darker versions for text.
ROW_INKS = ("#005f96", "#946500", "#0e6453", "#a54800")
#: Colours of the choices of a question, on green trees.
CHOICES = ("#005f96", "#a54800", "#6a3d9a", "#2f2f2f")
#: Colour of row names if the dots of the rows are not coloured.
ROW_INK = "#4d6650"
NO_ROW = "#a6a6a6"
#: Outline of a block.
BLOCK_EDGE = "#8fa08d"
FAINT_ROW = "#9db79a"

INK = "#2f2f2f"
QUIET_INK = "#6f6f6f"
GROUND, FENCE = "#f7f4ea", "#8a7f66"
KEEP_OUT_FILL, KEEP_OUT_EDGE = "#bfd7e6", "#4d7c99"
#: Ground that a mission keeps out of.
AVOIDED = "#b3261e"
ZONE_FILL, ZONE_EDGE, ZONE_INK = "#efdcae", "#c19a3f", "#8a6a1c"

LANE, HEADLAND, LINK = "#b9ad94", "#8f7f5f", "#a39a8a"
NARROW = "#b3261e"
GATE = "#6a3d9a"
UNREACHABLE = "#b3261e"

#: A robot's path, planned or driven, and a capture or drive that failed; the same on every map.
PATH, FAILED = "#26324f", "#b3261e"

#: Symbol, colour and word of each marker.
MARKERS = {"start": ("^", "#1a7f37", "start"), "end": ("s", "#b3261e", "end"), "charger": ("D", "#d48806", "charger")}
