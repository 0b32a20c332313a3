"""The base classes of selectors.

A selector is an expression. The innermost part is a source (every tree, a marker, the current place); each part around
it filters, orders or picks from what its ``of`` selects. "Yellow trees in the northern half" is
``Where(attribute="leaf_color", test="eq", value="yellow", of=Half(side="north", of=Trees()))``.

Each selector has its own file with its data, resolution, wording and size. Its fields define its XML
(:mod:`fieldhand.task.codec_shapes`), and its docstring is its definition in the prompt of language models.
:mod:`fieldhand.places.selectors` registers it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, ClassVar, Literal

from fieldhand.compatibility import Self
from fieldhand.language import message
from fieldhand.language.words import say_zone
from fieldhand.places.count_range import ANY, ONE, CountRange, exactly
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.ordinals import say_ordinal, say_ranked_tree
from fieldhand.places.place_errors import too_few

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Place, Site
    from fieldhand.terms import MarkerName, Side

#: State that determines the places of a selector: only the site; the robot's position, which affects the choice but not
#: the existence of places; the mission so far; or the values that it has read.
DependsOn = Literal["site", "nearness", "mission", "readings"]

#: Reference group of a region around a selector (rules: :mod:`fieldhand.places`). ``own``: the selector itself.
#: ``region``: the selector applied to the reference group of its ``of``. ``of``: the reference group of its ``of``, as
#: the selector does not change the geometry. ``pick`` and ``group``: like ``of`` for halves and edges, but for corners
#: and middles like ``own`` and ``region``.
ReferenceRule = Literal["own", "region", "of", "pick", "group"]


@dataclass(frozen=True, kw_only=True)
class Selector(ABC):
    """The base class of selectors, which name places without coordinates (``fh.selectors``).

    A selector is immutable. :func:`fieldhand.places.resolution.resolve` returns its places on a site.

    Example:
        >>> Where(attribute="leaf_color", test="eq", value="yellow", of=Rows(first="2", last="4"))
    """

    #: True if it always counts from a compass side, so that a side in the request may refer to it without a field.
    counts_from_a_side: ClassVar[bool] = False

    @classmethod
    @abstractmethod
    def example(cls, site: Site) -> Selector:
        """Return an example as a planner would write it, for a context with a current tree and a label."""

    @abstractmethod
    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the selected places.

        Args:
            resolution: Resolves nested selectors.
            notes: Receives the applied rule and remarks on surprising results.
        """

    @abstractmethod
    def phrase(self, wording: SelectorWording) -> NounPhrase:
        """Return the selector in words.

        Args:
            wording: Returns the phrases of nested selectors.
        """

    @property
    def single(self) -> bool:
        """True if the form guarantees at most one place ("the northernmost tree", not "trees in the north")."""
        return False

    @property
    def size(self) -> CountRange:
        """The range of the number of distinct places, as far as the form determines it."""
        return ONE if self.single else ANY

    @property
    def sides(self) -> tuple[Side, ...]:
        """The compass sides that it selects, without sides it counts from and without all four corners together."""
        return ()

    @property
    def depends_on(self) -> DependsOn:
        """The state that its places depend on, apart from its nested selectors."""
        return "site"

    @property
    def keeps_order(self) -> bool:
        """True if its places have an order of their own instead of that of the file."""
        return False

    @property
    def measured_from(self) -> Selector | None:
        """The nested selector from which distances are measured; None if there is none."""
        return None

    @property
    def whole_zone(self) -> str:
        """The zone of which it selects all trees, so that distances are measured from the zone itself; else empty."""
        return ""

    @property
    def named_tree(self) -> str:
        """The id of the tree that it names; else empty."""
        return ""

    @property
    def named_marker(self) -> MarkerName | Literal[""]:
        """The name of the marker that it selects; else empty."""
        return ""

    @property
    def members(self) -> tuple[Selector, ...]:
        """The selectors whose places it joins: the parts of a union; for any other selector, the selector itself."""
        return (self,)

    @property
    def by_series(self) -> tuple[str, str] | None:
        """The name and quantity of the readings of this mission by which it selects; None for other selectors."""
        return None

    @property
    def uses_records(self) -> bool:
        """True if its places, apart from its nested selectors, depend on what earlier missions did on the site."""
        return False

    @property
    def decided_by_readings(self) -> bool:
        """True if the values that the mission reads determine the places."""
        return any(part.depends_on == "readings" for part in self.walk())

    @property
    def any_of(self) -> Selector | None:
        """The group from which it takes any few places with a short drive; None for other selectors."""
        return None

    @property
    def row_of(self) -> Selector | None:
        """The place relative to whose row it selects a row; None for other selectors."""
        return None

    @property
    def central(self) -> bool:
        """True if it picks the trees nearest to the middle of an area or edge."""
        return False

    @property
    def from_start(self) -> Selector:
        """The selector with the start in place of a current place that only determines the nearest places."""
        return self

    @property
    def inner(self) -> Iterator[Selector]:
        """The directly nested selectors."""
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
        """True if the places depend on the robot's position or previous visits, and are resolved on arrival."""
        return any(part.depends_on != "site" for part in self.walk())

    def reference(self, *, picks_too: bool = True) -> Selector:
        """Return the selector of the reference group: without the parts that do not change the geometry.

        Args:
            picks_too: Also remove parts that pick trees by attribute or row; otherwise only parts that depend on the
                mission so far.
        """
        del picks_too
        return self

    def ground(self, resolution: Resolution) -> BaseGeometry:
        """Return the ground that it names in local metres, for work over an area: by default the outline of its trees.

        Raises:
            PlaceError: It selects nothing.
        """
        from fieldhand.places.ground import ground_of_trees

        found = resolution.spots(self)
        return ground_of_trees(resolution.site, found.index[found.is_tree].tolist())

    def it(self, wording: SelectorWording) -> str:
        """Return the selector in words that can follow "next to"."""
        return wording.phrase(self).say()

    def from_it(self, wording: SelectorWording) -> str:
        """Return the origin of a count in words; empty if it is obvious."""
        return self.it(wording)

    def as_origin(self, wording: SelectorWording) -> str:
        """Return the origin of a distance in words: a zone itself instead of its trees."""
        return say_zone(self.whole_zone) if self.whole_zone else self.it(wording)

    def left_out(self, wording: SelectorWording) -> str:
        """Return the clause of a group without its places: "other than the yellow trees"."""
        return message("other than {place}", place=self.it(wording))

    def aside(self, phrase: str) -> str:
        """Return the addition in brackets after the name of the single place; empty if the name is complete.

        Args:
            phrase: The selector in words.
        """
        return phrase

    def say_groups(self, places: Sequence[Place], site: Site) -> str:
        """Return its places in words by the groups from which it chooses them; empty if there are none."""
        del places, site
        return ""

    def nth_phrase(self, number: int, wording: SelectorWording) -> NounPhrase:
        """Return the phrase for the n-th place of this selector; -1 is the last."""
        group = wording.phrase(self)
        if group.plain:
            text = say_ranked_tree(number)
        else:
            text = message("the {ordinal} of {trees}", ordinal=say_ordinal(number, "one"), trees=group.group())
        return one(message("{trees}, {order}", trees=text, order=group.order) if group.order else text)


class FromGroup(Selector):
    """The base class of selectors that filter, order or pick from the places of another selector.

    Attributes:
        of: Selector of the group.
        reference_rule: Contribution of this selector to the reference group of a region around it.
    """

    of: Selector

    reference_rule: ClassVar[ReferenceRule] = "own"

    @abstractmethod
    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the selected places of a group, in order.

        Args:
            of: Places of ``of``, at least one.
            resolution: Resolves other nested selectors.
            notes: Receives the applied rule and remarks on surprising results.
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
        """Return a copy of the selector for another group."""
        return replace(self, of=of)  # type: ignore[call-arg]  # each subclass is a dataclass with that field


class Counted(FromGroup):
    """The base class of selectors that pick a fixed number of places from a group.

    Attributes:
        count: Number of places, at least 1.
    """

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

    def enough(self, candidates: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> int:
        """Return the number of places to pick: fewer than ``count`` only of a group that earlier missions determine.

        Raises:
            PlaceError: There are too few candidates.
        """
        left = len(candidates)
        if not 0 < left < self.count or not any(part.uses_records for part in self.of.walk()):
            self.need(candidates, resolution)
            return self.count
        notes.remark(message("{count} were asked for, but only {known} are left", count=self.count, known=left))
        return left

    def need(self, candidates: PlaceGroup, resolution: Resolution) -> None:
        """Check that there are enough candidates.

        Raises:
            PlaceError: There are fewer than ``count``.
        """
        if self.count < 1 or len(candidates) < self.count:
            raise too_few(resolution.site, self, self.count, len(candidates))
