"""What is being said of places: what labels are called, the phrases so far, and what all phrases share."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from fieldhand.language import message
from fieldhand.site.places.nesting import bare_ground
from fieldhand.site.places.noun import Phrase
from fieldhand.task import selectors as s
from fieldhand.task.words import say_name

Names = Mapping[str, str]


class Saying:
    """What is being said: what labels are called, and the phrases so far, since a group is often said again.

    Args:
        names: What a label is called.
        say: Makes the phrase of a selector.
    """

    def __init__(self, names: Names, say: Callable[[s.Selector, Saying], Phrase]) -> None:
        self.names = names
        self._say = say
        self._known: dict[str, Phrase] = {}

    def phrase(self, selector: s.Selector) -> Phrase:
        """The phrase of a selector."""
        key = repr(selector)
        if key not in self._known:
            self._known[key] = self._say(selector, self)
        return self._known[key]


def say_tree(tree: str) -> str:
    """A tree by its id: "tree 81"."""
    return message("tree {id}", id=tree)


def say_marker(name: str) -> str:
    """A marker in words: "the end marker", "the charger"."""
    match name:
        case "charger":
            return message("the charger")
        case "start":
            return message("the start marker")
        case "end":
            return message("the end marker")
    return message("the {name} marker", name=say_name(name))


def say_gate(gate: str) -> str:
    """Return a gate in words: "the gate", or "the gate “north gate”" where it has a name of its own."""
    return message("the gate") if say_name(gate).lower() == "gate" else message("the gate “{gate}”", gate=gate)


def say_zone(zone: str) -> str:
    """A zone by its name: "the zone “wet corner”"."""
    return message("the zone “{zone}”", zone=zone)


def one(text: str) -> Phrase:
    """The phrase of one place."""
    return Phrase(closed=text, single=True)


def many(text: str) -> Phrase:
    """The phrase of several places."""
    return Phrase(closed=text)


def it(selector: s.Selector, saying: Saying) -> str:
    """A place where "there" would be no English ("next to there")."""
    return message("that place") if isinstance(selector, s.Here) else saying.phrase(selector).say()


def origin(selector: s.Selector, saying: Saying) -> str:
    """Return the place that something is near to or far from in words: a zone itself, not the trees in it."""
    zone = s.zone_itself(selector)
    return say_zone(zone) if zone else it(selector, saying)


def of_ground(of: s.Selector, saying: Saying) -> str:
    """Of what a half or an edge is one, where it is not the whole site (the rule stands in ``site.places``)."""
    ground = bare_ground(of)
    return "" if ground == s.Trees() else message("of {trees}", trees=saying.phrase(ground).group())
