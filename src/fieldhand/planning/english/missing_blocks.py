"""Blocks that a request names by a side, on a site whose blocks have other names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fieldhand.language import message
from fieldhand.language.words import some_names
from fieldhand.planning.english.naming import split
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.planning.planner import Reason
from fieldhand.site.model import Site

_BLOCK = frozenset({"block", "blocks"})
#: Words that go on with a side behind "block": "the block north of the pond" names none.
_GOES_ON = frozenset({"of", "to", "half", "side", "end", "corner", "edge", "part", "from", "by", "block", "quarter"})


def missing_blocks(words: Sequence[Word], site: Site) -> Iterator[Reason]:
    """Yield a reason for each block that is named by a side and that the site does not have.

    On a site with one block, or with blocks that have no names, a side is a part of the site.
    """
    names = [block.name for block in site.planting.blocks]
    known = {"".join(split(name)) for name in names}
    if len(names) < 2 or all(name.isdigit() for name in names):
        return
    sides = {form for forms in vocabulary()["sides"].values() for form in forms}
    norms = [word.norm for word in words]
    for k, norm in enumerate(norms):
        after = norms[k + 1] if k + 1 < len(norms) else ""
        before = norms[k - 1] if k else ""
        called = after in _BLOCK or (before == "block" and after not in _GOES_ON)
        if norm in sides and called and norm not in known and before not in sides and words[k - 1].kind != "dash":
            yield Reason(
                what=message("there is no block '{said}'", said=words[k].text),
                said=((words[k].start, words[k].end),),
                advice=message("this site has block {there}", there=some_names(names, 6)),
                final=True,
                instead=names[0],
            )
