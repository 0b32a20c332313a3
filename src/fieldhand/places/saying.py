"""What is being said of places: what labels are called, the phrases so far, and what all phrases share."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from fieldhand.language import message
from fieldhand.language.words import say_zone
from fieldhand.places import selectors as s
from fieldhand.places.nesting import bare_ground
from fieldhand.places.noun import Phrase

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
    """Of what a half or an edge is one, where it is not the whole site (:mod:`fieldhand.places` gives the rule)."""
    ground = bare_ground(of)
    return "" if ground == s.Trees() else message("of {trees}", trees=saying.phrase(ground).group())
