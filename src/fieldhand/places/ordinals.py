"""Wording of ordinals: "third", "12th", "second last"."""

from __future__ import annotations

from typing import Literal

from fieldhand.language import message

#: Noun of an ordinal, which other languages inflect differently.
Ranked = Literal["tree", "row", "one"]


def say_ordinal(number: int, of: Ranked = "tree") -> str:
    """Return an ordinal: "third", "12th", or "last", "second last" for negative numbers."""
    if number == -1:
        return message("last", context=of)
    if number < 0:
        return message("{ordinal} last", context=of, ordinal=say_ordinal(-number, of))
    match number:
        case 1:
            return message("first", context=of)
        case 2:
            return message("second", context=of)
        case 3:
            return message("third", context=of)
        case 4:
            return message("fourth", context=of)
        case 5:
            return message("fifth", context=of)
        case 6:
            return message("sixth", context=of)
        case 7:
            return message("seventh", context=of)
        case 8:
            return message("eighth", context=of)
        case 9:
            return message("ninth", context=of)
        case 10:
            return message("tenth", context=of)
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    match ending:
        case "st":
            return message("{number}st", context=of, number=number)
        case "nd":
            return message("{number}nd", context=of, number=number)
        case "rd":
            return message("{number}rd", context=of, number=number)
    return message("{number}th", context=of, number=number)


def say_ranked_tree(number: int) -> str:
    """Return a tree with its ordinal: "the third tree", "the second last tree"."""
    if number < -1:
        return message("the {ordinal} last tree", ordinal=say_ordinal(-number))
    return message("the {ordinal} tree", ordinal=say_ordinal(number))
