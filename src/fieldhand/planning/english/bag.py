"""The words of one noun phrase, taken out one after the other as they are understood; what is left is a fault."""

from __future__ import annotations

from dataclasses import dataclass, field

from fieldhand.language import message
from fieldhand.planning.english.faults import PLAINLY, Unclear, spans_of, text_of, unclear
from fieldhand.planning.english.syntax import PlacePhrase
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.planner import Reason

#: Articles that say that the hearer knows which one is meant.
_DEFINITE = frozenset({"the", "this", "that", "these", "those"})
#: What says the same as "tree" behind another word ("the corner tree", "the middle of the orchard").
_EMPTY = frozenset({"TREE", "PLOT"})


@dataclass
class Bag:
    """The words of a noun phrase.

    Attributes:
        count: The number that it says.
        article: Its article, if it has one.
        each, any, another, as_many, up_to, more: Which quantifiers it has.
        spread: It says that the trees are spread over something, by these words; none if it does not.
        plural: One of its nouns stands in the plural.
        ids: Trees that it names.
        compared: Comparisons, each with its terms, negation first.
    """

    phrase: PlacePhrase
    count: int | None = None
    article: str = ""
    each: bool = False
    any: bool = False
    another: bool = False
    as_many: bool = False
    up_to: bool = False
    more: bool = False
    spread: tuple[Term, ...] = ()
    plural: bool = False
    ids: list[str] = field(default_factory=list)
    compared: list[tuple[Term, ...]] = field(default_factory=list)
    _words: dict[str, list[Term]] = field(default_factory=dict)

    @property
    def definite(self) -> bool:
        """Whether it speaks of what is known ("the tree")."""
        return self.article in _DEFINITE

    @property
    def pointing(self) -> bool:
        """Whether it points at what was spoken of ("this tree", "those trees")."""
        return self.article in _DEFINITE - {"the"}

    @property
    def plural_article(self) -> bool:
        """Whether it points at several ("those")."""
        return self.article in ("these", "those")

    def take(self, *kinds: str) -> Term | None:
        """The first word of one of these kinds, taken out."""
        for kind in kinds:
            words = self._words.get(kind)
            if words:
                word = words.pop(0)
                if not words:
                    del self._words[kind]
                return word
        return None

    def words(self, kind: str) -> tuple[Term, ...]:
        """The words of a kind that are left."""
        return tuple(self._words.get(kind, ()))

    def take_behind(self, kind: str, start: int) -> list[Term]:
        """The words of a kind that stand behind a place of the request, taken out."""
        words = self._words.pop(kind, [])
        before = [word for word in words if word.start < start]
        if before:
            self._words[kind] = before
        return [word for word in words if word.start > start]

    def put(self, kind: str, words: list[Term]) -> None:
        """Put words back."""
        if words:
            self._words.setdefault(kind, []).extend(words)

    def has(self, *kinds: str) -> bool:
        """Whether a word of one of these kinds is left."""
        return any(kind in self._words for kind in kinds)

    def only(self, *kinds: str) -> bool:
        """Whether no word but of these kinds is left, and no comparison."""
        return not self.compared and not self.ids and set(self._words) <= set(kinds)

    def describes(self, *kinds: str) -> bool:
        """Whether it holds only words of these kinds and comparisons, and some."""
        return bool(self._words or self.compared) and not self.ids and set(self._words) <= set(kinds)

    def join(self, other: Bag) -> None:
        """Take over the words of another phrase that describes the same ("trees | with yellow leaves")."""
        for kind, words in other._words.items():
            self._words.setdefault(kind, []).extend(words)
        other._words.clear()
        self.compared += other.compared

    def finish(self) -> None:
        """Check that every word has been understood.

        Raises:
            Unclear: Some were not.
        """
        left = [t for kind, words in self._words.items() if kind not in _EMPTY for t in words]
        left += [t for group in self.compared for t in group]
        left += self.spread
        if self.up_to or self.as_many or self.more:
            left += [t for t in self.phrase.quantity if t.kind in ("UPTO", "ASMANY", "MORE")]
        if left:
            words = ", ".join(f"'{t.text}'" for t in left)
            what = message("{words} could not be interpreted in '{said}'", words=words, said=text_of(self.phrase.terms))
            raise Unclear(Reason(what=what, said=spans_of(left), advice=message("say it in simpler words")))

    def fault(self, what: str, advice: str = PLAINLY) -> Unclear:
        """A fault of this phrase."""
        return unclear(self.phrase.terms, what, advice)


def bag_of(phrase: PlacePhrase) -> Bag:
    """The words of a phrase."""
    bag = Bag(phrase=phrase)
    for term in phrase.quantity:
        _quantify(bag, term)
    for group in phrase.nominals:
        head = group[0]
        if head.kind == "IDS":
            bag.ids.extend(head.value)
        elif head.kind in ("CMP", "BETWEEN", "NOT", "ISNOT"):
            bag.compared.append(group)
        elif head.kind == "ASCAN":
            continue
        elif head.kind not in ("WHICH", "IS"):
            bag._words.setdefault(head.kind, []).append(head)
            bag.plural = bag.plural or head.plural
    return bag


def _quantify(bag: Bag, term: Term) -> None:
    match term.kind:
        case "NUM":
            if bag.count is not None or term.value != int(term.value) or term.value < 1:
                raise unclear(bag.phrase.terms, message("it is not clear how many"), message("say one whole number"))
            bag.count = int(term.value)
        case "EACH":
            bag.each = True
            if term.text.lower().startswith("both"):
                bag.count, bag.plural = bag.count or 2, True
        case "ANY":
            bag.any = True
        case "ANOTHER":
            bag.another = True
        case "ASMANY":
            bag.as_many = True
        case "UPTO":
            bag.up_to = True
        case "MORE":
            bag.more = True
        case _:
            bag.article = term.text.lower()
