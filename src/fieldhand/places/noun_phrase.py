"""A noun phrase about trees, and how it grows: adjectives before the noun, rows and clauses behind it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.language import counted, joined, message, named, shaped

#: No phrase is longer than this, however often a Task says a group within a group.
_LONGEST = 20_000


@dataclass(frozen=True, kw_only=True)
class NounPhrase:
    """A noun phrase about trees.

    Attributes:
        closed: The whole phrase where something was picked; then the other parts are empty, but for the order.
        single: It means one place.
        before, after: Adjectives and what follows the noun, in the order in which they are said.
        row, block: Of which rows ("rows 2 to 5") and of which block the trees are.
        one_row: ``row`` is one.
        among: The closed phrase of which the trees are kept.
        order: The order in which they are meant ("from west to east").
    """

    closed: str = ""
    single: bool = False
    before: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    row: str = ""
    one_row: bool = False
    block: str = ""
    among: str = ""
    order: str = ""

    @property
    def plain(self) -> bool:
        """Every tree of the site."""
        return replace(self, order="") == NounPhrase()

    @property
    def bare(self) -> bool:
        """Every tree of some rows, or of the site."""
        return not (self.closed or self.before or self.after or self.among)

    def keeping(self, *, before: str = "", after: str = "") -> NounPhrase:
        """The phrase narrowed by one more adjective or clause."""
        base = NounPhrase(among=self.closed, order=self.order) if self.closed else self
        return replace(
            base,
            before=(*base.before, before) if before else base.before,
            after=(*base.after, after) if after else base.after,
        )

    def of_rows(self, row: str, *, one: bool) -> NounPhrase:
        """The phrase narrowed to some rows; what is of some rows already is what they are looked for among."""
        open_ = not (self.closed or self.row)
        base = self if open_ else NounPhrase(among=replace(self, order="").say(), order=self.order)
        return replace(base, row=row, one_row=one)

    def of_block(self, block: str) -> NounPhrase:
        """The phrase narrowed to one block."""
        open_ = not (self.closed or self.block)
        base = self if open_ else NounPhrase(among=replace(self, order="").say(), order=self.order)
        return replace(base, block=block)

    def say(self, count: int | None = None) -> str:
        """The phrase with its article, and how many there are where that is known."""
        said = self._unordered(count)
        return message("{trees}, {order}", trees=said, order=self.order) if self.order else said

    def _unordered(self, count: int | None = None) -> str:
        text = self._whole(count)
        return text if len(text) <= _LONGEST else shaped(text, _cut)

    def _whole(self, count: int | None) -> str:
        if self.closed:
            return self.closed
        if self.plain:
            return message("every tree") if count is None else counted("all {count} tree", "all {count} trees", count)
        after, adjectives = clauses(self), self.adjectives(count)
        if count is None:
            return message("the {adjectives} trees {clauses}", adjectives=adjectives, clauses=after)
        return counted(
            "the {count} {adjectives} tree {clauses}",
            "the {count} {adjectives} trees {clauses}",
            count,
            adjectives=adjectives,
            clauses=after,
        )

    def group(self) -> str:
        """The phrase as something to pick from, whatever its order: "the yellow trees"."""
        return message("the trees") if self.plain else self._unordered()

    def adjectives(self, count: int | None = None) -> str:
        """What is said of so many trees with an adjective; of several where the count is not known."""
        return joined(" ", (named(word, "tree" if count == 1 else "trees") for word in self.before))

    @property
    def of_what(self) -> str:
        """Of which rows, of which block: "of row 3 of block B"; empty for the whole site."""
        return joined(" ", [message("of {part}", part=part) for part in (self.row, self.block) if part])

    @property
    def whose(self) -> str:
        """The rows and the block without the preposition: "row 3 of block B"; empty for the whole site."""
        if self.row and self.block:
            return message("{rows} of {block}", rows=self.row, block=self.block)
        return self.row or self.block


def one(text: str) -> NounPhrase:
    """The phrase of one place."""
    return NounPhrase(closed=text, single=True)


def many(text: str) -> NounPhrase:
    """The phrase of several places."""
    return NounPhrase(closed=text)


def clauses(phrase: NounPhrase, *more: str) -> str:
    """What follows the noun; a comma keeps a second clause from being read as part of the first."""
    among = (message("among {trees}", trees=phrase.among),) if phrase.among else ()
    clauses = (*sorted(phrase.after, key=lambda a: not a.startswith("whose ")), *among)
    parted = joined(", ", clauses)
    return joined(" ", [part for part in (phrase.of_what, parted, *more) if part])


def _cut(text: str) -> str:
    return f"{text[:_LONGEST]}…"
