"""What is left unsaid because it was said before: "another", "two more there", "three more times"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.language.words import say_times
from fieldhand.places import selectors as s
from fieldhand.planning.english import draft as d
from fieldhand.planning.english import repeating
from fieldhand.planning.english.asking import choices_of_actions
from fieldhand.planning.english.counting import Wanted
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.hand import ACTS
from fieldhand.planning.english.leaving import Leaving
from fieldhand.planning.english.places import find
from fieldhand.planning.english.syntax import ClausePart
from fieldhand.planning.selections import may_be_listed


class Elliptic(Leaving):
    """Reads parts that go on with what the command before them asks for."""

    def _elided(self, part: ClausePart) -> tuple[ClausePart, Wanted] | None:
        """ "Another", "two in the western half": of what, the command before says. None if the part names trees."""
        if part.places is None or not find(part.places, self._site).object_only:
            return None
        found = find(part.places, self._site)
        if any(t.kind == "THERE" for t in part.tails) and found.counted != 1:
            raise unclear(
                part.terms, message("it is not clear which of them"), message("say how many trees in one sentence")
            )
        if len(part.places.chains) > 1:
            raise unclear(part.terms, message("it is not clear of what"), message("say each in a sentence of its own"))
        if len({action for action, _ in self._objects}) > 1:
            names = choices_of_actions(action for action, _ in self._objects)
            raise Question(message("'{said}': another of which?", context="question", said=text_of(part.terms)), names)
        wanted = self._wanted((), part)
        objects = tuple((action, found.counted or count) for action, count in wanted[:1])
        first = part.places.chains[0]
        if len(first.phrases) == 1:
            return replace(part, places=None, relation=None), objects
        rest = replace(first, phrases=first.phrases[1:], relations=first.relations[1:])
        places = replace(part.places, chains=(rest,))
        return replace(part, places=places, relation=first.relations[0]), objects

    def _at_each_of_them(self, part: ClausePart) -> bool:
        """ "For each of them: ...": what follows is done at each of the places that were spoken of. Whether it is."""
        if part.places is None or not any(p.kind in (*ACTS, "condition") for p in self._following[:1]):
            return False
        found = find(part.places, self._site)
        if not (found.here and found.these):
            return False
        self._gather(part)
        if self._loop is None or not self._within(self._loop.body, self.told.root):
            return False
        self._loop.said += part.said
        self._scope = self._loop.body
        return True

    def _ends_a_series(self, part: ClausePart) -> bool:
        """ "..., then the south-west corner, and finish in the north-east": the last place of a series."""
        if (
            part.places is None
            or self._following
            or not self._objects
            or self._last_verb not in ("repeat", "act_on_objects")
        ):
            return False
        found = find(part.places, self._site)
        if found.selector.named_marker or found.here or found.region or found.many:
            return False
        same = [
            step.at for step, _ in d.walk(self.told.root) if isinstance(step, d.DraftCapture) and step.at is not None
        ]
        same += [step.place for step, _ in d.walk(self.told.root) if isinstance(step, d.Go)]
        return sum(type(at) is type(found.selector) for at in same) > 1

    def _gone_to(self, part: ClausePart) -> set[int]:
        """The steps of this sentence from the last place on that it goes to: what is done again comes before them."""
        said_where = part.places is not None and not self._related(part).here
        placed = [k for k, st in enumerate(self._sentence_steps) if repeating.has_place(st)]
        if said_where or not placed:
            return set()
        last = self._sentence_steps[placed[-1]]
        if any(t.kind == "COUNT" for t in part.tails) and not isinstance(last, d.Go):
            return set()
        return {id(step) for step in self._sentence_steps[placed[-1] :]}

    def _in_another_area(self, old: list[d.Step], found: FoundPlace, part: ClausePart) -> bool:
        """ "Do the same in row 8" behind what was done at several places of row 6. Whether it is that."""
        passage = repeating.passage_in_area(old, found.selector)
        made = repeating.copied(passage, lambda _: True, self._fresh)
        if not passage.steps or not repeating.in_area(made, found.selector):
            return False
        for step in made.steps:
            step.said += part.said
        repeating.append(made, self._scope)
        return True

    def _lists(self, part: ClausePart) -> bool:
        """ "At the corners: first the south-west one, then ...": the places one by one that were named together."""
        loop = self._loop
        if loop is None or loop not in self._sentence_steps or part.places is None:
            return False
        if part.listed and may_be_listed(loop.select):
            self._listing, loop.select = loop, s.UnionOf(parts=())
        if self._listing is not loop or loop.select.members == (loop.select,):
            return False
        found = self._related(part)
        if found.here or found.object_only or found.optional or found.at_most is not None:
            raise unclear(part.terms, message("is that one of the places?"), message("name the places in one list"))
        loop.select = s.UnionOf(parts=(*loop.select.members, *found.selector.members))
        loop.said += part.said
        if part.then:
            loop.order = "given"
        return True

    def _says_again(self, part: ClausePart, wanted: Wanted) -> bool:
        """ "..., one leaf sample per tree": what the command before it asks for already. Whether it is."""
        last = self._loop.body.steps[-1] if self._loop is not None and self._loop.body.steps else None
        each = self._loop is not None and self._loop in self._sentence_steps
        if (
            not each
            or not isinstance(last, d.DraftCapture)
            or wanted not in (((last.action, 1),), ((last.action, None),))
        ):
            return False
        there = any(t.kind in ("THERE", "EACHTAIL") for t in part.tails) or (
            part.places is not None and [t.kind for t in part.places.terms] == ["EACH", "TREE"]
        )
        if there and last.count == 1 and not any(t.kind in ("COUNT", "AGAIN") for t in part.tails):
            last.said += part.said
            return True
        return False

    def _captured_next(self) -> bool:
        """Whether what follows in the sentence is captured at the places that have just been named."""
        ahead = next((p for p in self._following if p.kind not in ("order", "distinct", "budget")), None)
        if ahead is None or ahead.kind not in ("more_objects", "act_on_objects"):
            return False
        return ahead.places is None or self._related(ahead).here

    def _further(self, part: ClausePart, times: int) -> int:
        """How many times more a passage is done that has been done once: "three more times", "three times in all"."""
        said = next(t.text.lower() for t in part.tails if t.kind == "COUNT")
        if "more" in said.split() or "further" in said.split():
            return times
        if said.split()[-1] in ("all", "total", "altogether", "overall"):
            if times < 2:
                raise unclear(part.terms, message("it is already done once"))
            return times - 1
        again = say_times(times)
        raise Question(
            message(
                "'{said}': {again} in all, or {again} more?", context="question", said=text_of(part.terms), again=again
            ),
            (
                message("{times} times in all", context="answer", times=times),
                message("{times} more times", context="answer", times=times),
            ),
            terms=[t for t in part.tails if t.kind == "COUNT"],
        )
