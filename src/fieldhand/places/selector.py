"""The base classes of selectors.

A selector is an expression. The innermost part is a source (every tree, a marker, the place in hand); each part around
it keeps, orders or picks from what its ``of`` selects. "Yellow trees in the northern half" is
``Where(attribute="leaf_color", test="eq", value="yellow", of=Half(side="north", of=Trees()))``.

Each selector has a file of its own with its data, the places it resolves to, its words and its size. Its fields are its
XML (:mod:`fieldhand.task.codec_shapes`), its docstring is its definition for language models.
:mod:`fieldhand.places.selectors` registers it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, ClassVar, Literal, Self

from fieldhand.language import message
from fieldhand.language.words import say_zone
from fieldhand.places.count_range import ANY, ONE, CountRange, exactly
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.ordinals import say_ordinal, say_ranked_tree
from fieldhand.places.place_errors import too_few

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site
    from fieldhand.terms import MarkerName, Side

#: Inputs that determine the places of a selector: the site alone; the distance to the robot, which only decides which
#: places are taken, not whether there are any; or the mission so far.
DependsOn = Literal["site", "nearness", "mission"]

#: The trees that define the area of a region (half, edge, corner, middle) around a selector; :mod:`fieldhand.places`
#: gives the reasons. For "the north half of X":
#:
#: - ``own``: the trees of X themselves ("the north half of block B" divides block B);
#: - ``region``: the trees that a region around X's own region would use, since X is a region, too;
#: - ``of``: the trees of X's ``of``, since X only filters ("the yellow trees in the north half");
#: - ``pick``: as ``of`` for halves and edges, as ``own`` for corners and middles;
#: - ``group``: as ``of`` for halves and edges, as ``region`` for corners and middles.
ReferenceRule = Literal["own", "region", "of", "pick", "group"]


@dataclass(frozen=True, kw_only=True)
class Selector(ABC):
    """A part of a Task that names places without coordinates."""

    #: True if it counts from a side of the compass, so that a side in the request may refer to it without any field.
    counts_from_a_side: ClassVar[bool] = False

    @classmethod
    @abstractmethod
    def example(cls, site: Site) -> Selector:
        """Return one as a planner would write it, for a context in which a tree is in hand and bound."""

    @abstractmethod
    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the places that are meant.

        Args:
            resolution: Resolves the selectors inside this one.
            notes: Takes the rule that is applied and what a person may not expect.
        """

    @abstractmethod
    def phrase(self, wording: SelectorWording) -> NounPhrase:
        """Return the selector in words.

        Args:
            wording: Says the selectors inside this one.
        """

    @property
    def single(self) -> bool:
        """True if the form promises at most one place ("the northernmost tree", not "trees in the north")."""
        return False

    @property
    def size(self) -> CountRange:
        """The number of distinct places, by the form alone."""
        return ONE if self.single else ANY

    @property
    def sides(self) -> tuple[Side, ...]:
        """The sides of the compass that it goes to: not where it counts from, nor all four corners together."""
        return ()

    @property
    def depends_on(self) -> DependsOn:
        """The state that its places depend on, beside the parts inside it."""
        return "site"

    @property
    def keeps_order(self) -> bool:
        """True if its places come in an order of its own, not in that of the file."""
        return False

    @property
    def measured_from(self) -> Selector | None:
        """The selector inside from which distances are measured."""
        return None

    @property
    def whole_zone(self) -> str:
        """The zone whose trees it selects, all of them: distances are measured from the zone itself. Else empty."""
        return ""

    @property
    def named_tree(self) -> str:
        """The id of the one tree that it names, else empty."""
        return ""

    @property
    def named_marker(self) -> MarkerName | Literal[""]:
        """Return the name of the site's marker that it is, else an empty one."""
        return ""

    @property
    def members(self) -> tuple[Selector, ...]:
        """Return the selectors whose places it joins: the parts of a union; of every other selector itself alone."""
        return (self,)

    @property
    def any_of(self) -> Selector | None:
        """Return the group of which it takes any few, those that make a short drive; None if it takes none so."""
        return None

    @property
    def row_of(self) -> Selector | None:
        """Return the place whose row it selects, or a row so many from that row; None for every other selector."""
        return None

    @property
    def central(self) -> bool:
        """Return True if it picks the trees nearest to a middle: that of an area, or of an edge."""
        return False

    @property
    def from_start(self) -> Selector:
        """The selector with the start in place of a place in hand that only decides which places are the nearest."""
        return self

    @property
    def inner(self) -> Iterator[Selector]:
        """The selectors directly inside this one."""
        for field in fields(self):
            value = getattr(self, field.name)
            for item in value if isinstance(value, tuple) else (value,):
                if isinstance(item, Selector):
                    yield item

    def walk(self) -> Iterator[Selector]:
        """Yield this selector and every one inside it, outermost first."""
        yield self
        for part in self.inner:
            yield from part.walk()

    @property
    def relative(self) -> bool:
        """True if the places depend on where the robot is or has been, so that they resolve when they are reached."""
        return any(part.depends_on != "site" for part in self.walk())

    def reference(self, *, picks_too: bool = True) -> Selector:
        """Return the selector without the parts that leave the geometry as it is.

        Args:
            picks_too: Also without what picks trees by an attribute or by their row; else only without what depends on
                the mission so far.
        """
        del picks_too
        return self

    def it(self, wording: SelectorWording) -> str:
        """Return the selector in words that may follow "next to"."""
        return wording.phrase(self).say()

    def from_it(self, wording: SelectorWording) -> str:
        """Return in words from where something is counted, empty where that goes without saying."""
        return self.it(wording)

    def as_origin(self, wording: SelectorWording) -> str:
        """Return in words what something is near to or far from: a zone itself, not the trees in it."""
        return say_zone(self.whole_zone) if self.whole_zone else self.it(wording)

    def aside(self, said: str) -> str:
        """Return what stands in brackets behind the name of the one place, empty where the name is all of it.

        Args:
            said: The selector in words.
        """
        return said

    def nth_phrase(self, number: int, wording: SelectorWording) -> NounPhrase:
        """Return the place of a number among those of this selector in words; -1 is the last."""
        group = wording.phrase(self)
        if group.plain:
            said = say_ranked_tree(number)
        else:
            said = message("the {ordinal} of {trees}", ordinal=say_ordinal(number, "one"), trees=group.group())
        return one(message("{trees}, {order}", trees=said, order=group.order) if group.order else said)


class FromGroup(Selector):
    """A selector that keeps, orders or picks from what its ``of`` selects."""

    of: Selector

    reference_rule: ClassVar[ReferenceRule] = "own"

    @abstractmethod
    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return which of some places are meant, and in which order.

        Args:
            of: The places of ``of``, at least one.
            resolution: Resolves the other selectors inside this one.
            notes: Takes the rule that is applied and what a person may not expect.
        """

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        of = resolution.spots(self.of)
        notes.candidates = len(of)
        return self.choose(of, resolution, notes)

    @property
    def keeps_order(self) -> bool:
        return self.of.keeps_order

    def reference(self, *, picks_too: bool = True) -> Selector:
        rule = self.reference_rule
        if rule == "of" or (picks_too and rule in ("pick", "group")):
            return self.of.reference(picks_too=picks_too)
        if rule in ("own", "pick"):
            return self
        return self.around(self.of.reference(picks_too=picks_too))

    def around(self, of: Selector) -> Self:
        """Return the same selector of another group."""
        return replace(self, of=of)  # type: ignore[call-arg]  # each subclass is a dataclass with that field


class Counted(FromGroup):
    """A selector that picks a ``count`` from what its ``of`` selects."""

    count: int

    @property
    def single(self) -> bool:
        return self.count == 1

    @property
    def size(self) -> CountRange:
        return exactly(self.count)

    @property
    def keeps_order(self) -> bool:
        return True

    def need(self, candidates: PlaceGroup, resolution: Resolution) -> None:
        """Check that there are enough to choose from.

        Raises:
            PlaceError: There are fewer than the count.
        """
        if self.count < 1 or len(candidates) < self.count:
            raise too_few(resolution.site, self, self.count, len(candidates))
