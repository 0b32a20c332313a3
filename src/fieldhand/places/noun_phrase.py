"""A noun phrase about trees, extended by adjectives before the noun and by rows and clauses after it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.language import counted, joined, message, named, shaped

#: Maximum length of a phrase, however deep a Task nests groups.
_LONGEST = 20_000


@dataclass(frozen=True, kw_only=True)
class NounPhrase:
    """A noun phrase about trees.

    Attributes:
        closed: The whole phrase, once something was picked; the other parts except the order are then empty.
        single: True if it denotes one place.
        before: Adjectives.
        whose: Clauses about attributes after the noun ("whose age is above 10 years").
        after: Other clauses after the noun, in the order of the phrase.
        row, block: Rows ("rows 2 to 5") and block of the trees.
        one_row: True if ``row`` is a single row.
        outer_rows: The first and the last of a range of rows ("rows 2 and 5"), between which the others lie.
        among: The closed phrase from which the trees are filtered.
        order: Order of the places ("from west to east").
        every: True for a phrase with "every", which is singular although it denotes several places.
        listed: True for a list of several phrases.
    """

    closed: str = ""
    single: bool = False
    before: tuple[str, ...] = ()
    whose: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    row: str = ""
    one_row: bool = False
    outer_rows: str = ""
    block: str = ""
    among: str = ""
    order: str = ""
    every: bool = False
    listed: bool = False

    @property
    def plain(self) -> bool:
        """True for every tree of the site."""
        return replace(self, order="") == NounPhrase()

    @property
    def bare(self) -> bool:
        """True for every tree of some rows, or of the site."""
        return not (self.closed or self.before or self.whose or self.after or self.among)

    def keeping(self, *, before: str = "", whose: str = "", after: str = "") -> NounPhrase:
        """Return the phrase narrowed by one more adjective or clause."""
        base = NounPhrase(among=self.closed, order=self.order) if self.closed else self
        return replace(
            base,
            before=(*base.before, before) if before else base.before,
            whose=(*base.whose, whose) if whose else base.whose,
            after=(*base.after, after) if after else base.after,
        )

    def of_rows(self, row: str, *, one: bool, outer: str = "") -> NounPhrase:
        """Return the phrase narrowed to some rows; a phrase that has rows already becomes the group they are taken
        from.
        """
        open_ = not (self.closed or self.row)
        base = self if open_ else NounPhrase(among=replace(self, order="").say(), order=self.order)
        return replace(base, row=row, one_row=one, outer_rows=outer)

    def of_block(self, block: str) -> NounPhrase:
        """Return the phrase narrowed to one block."""
        open_ = not (self.closed or self.block)
        base = self if open_ else NounPhrase(among=replace(self, order="").say(), order=self.order)
        return replace(base, block=block)

    def say(self, count: int | None = None) -> str:
        """Return the phrase with its article, and with the number of places if known."""
        text = self._unordered(count)
        return message("{trees}, {order}", trees=text, order=self.order) if self.order else text

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
        """Return the phrase as a group to pick from, without its order: "the yellow trees"."""
        return message("the trees") if self.plain else self._unordered()

    def adjectives(self, count: int | None = None) -> str:
        """Return the adjectives, inflected for the number of trees; for several if it is unknown."""
        return joined(" ", (named(word, "tree" if count == 1 else "trees") for word in self.before))

    @property
    def of_what(self) -> str:
        """Return rows and block with the preposition: "of row 3 of block B"; empty for the whole site."""
        return joined(" ", [message("of {part}", part=part) for part in (self.row, self.block) if part])

    @property
    def rows_and_block(self) -> str:
        """Return rows and block without the preposition: "row 3 of block B"; empty for the whole site."""
        if self.row and self.block:
            return message("{rows} of {block}", rows=self.row, block=self.block)
        return self.row or self.block

    @property
    def outer_rows_and_block(self) -> str:
        """Return the rows between which a range lies: "rows 3 and 8 of block B"; otherwise the rows and the block."""
        return replace(self, row=self.outer_rows or self.row).rows_and_block


def one(text: str) -> NounPhrase:
    """Return the phrase for one place."""
    return NounPhrase(closed=text, single=True)


def many(text: str) -> NounPhrase:
    """Return the phrase for several places."""
    return NounPhrase(closed=text)


def clauses(phrase: NounPhrase, *more: str) -> str:
    """Return the clauses after the noun, separated by a comma so that each refers to the noun."""
    among = (message("among {trees}", trees=phrase.among),) if phrase.among else ()
    clauses = (*phrase.whose, *phrase.after, *among)
    parted = joined(", ", clauses)
    return joined(" ", [part for part in (phrase.of_what, parted, *more) if part])


def _cut(text: str) -> str:
    return f"{text[:_LONGEST]}…"
