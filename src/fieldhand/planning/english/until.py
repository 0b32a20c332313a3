""" "Until": a round of visits, or a repetition, that ends once a reading is as asked."""

from __future__ import annotations

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english import draft as d
from fieldhand.planning.english.cases import Cases
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.hand import ACTS
from fieldhand.planning.english.places import find
from fieldhand.planning.english.syntax import ClausePart
from fieldhand.planning.english.tested import place_in, read_condition


class Until(Cases):
    """Reads what ends a round early."""

    def _until(self, part: ClausePart) -> None:
        """ "Until one is above 38 °C": said of the round whose reading it tests.

        What follows without a place of its own is done where that reading was taken, and nowhere if none was.
        """
        terms, place = place_in(part.terms[1:])
        if place:
            raise unclear(
                part.terms,
                message("a repetition has to end on a reading taken during it"),
                message("say 'until one is below 33 °C'"),
            )
        known = [step for step, _ in d.walk(self.told.root) if isinstance(step, d.DraftCapture)]
        tested = read_condition(terms, known, self._robot, self._site)
        captures = [self._tested_capture(predicate, None, part, True) for predicate in tested.predicates]
        if any(capture is None for capture in captures):
            raise unclear(
                part.terms,
                message("a repetition can end on a reading, not on an attribute of a tree"),
                message("name the trees instead"),
            )
        round_ = self._round_of([capture for capture in captures if capture is not None])
        if round_ is None:
            raise Question(
                message("'{said}': at which trees, or how often at most?", context="question", said=text_of(part.terms))
            )
        if round_.until is not None or (isinstance(round_, d.Loop) and round_.optional):
            raise unclear(
                part.terms, message("that repetition already ends for another reason"), message("say one of them")
            )
        condition = tested.condition([self._bound(capture) for capture in captures])
        round_.until = condition
        round_.said += part.said
        self._ended = d.Choice(condition=condition, then=d.DraftBlock(), said=part.said)
        self._ended_round, self._found_one = round_, None

    def _has_no_place(self, part: ClausePart) -> bool:
        if part.kind == "stop":
            return False
        return part.places is None or self._related(part).here

    def _after_until(self, part: ClausePart) -> None:
        """Do what has no place of its own where a round ended, and nowhere if it ended without a reading as asked."""
        how_many = part.kind == "more_places" and any(t.kind == "UPTO" for t in part.terms)
        if self._ended is None or self._ended_round is None or how_many:
            return
        if part.kind in ACTS and self._has_no_place(part):
            if self._found_one is None:
                self._found_one = self._ended
                self._ended_round.body.add(self._ended)
            self._choice, self._scope = self._ended, self._ended.then
            return
        if self._found_one is not None and self._scope is self._found_one.then:
            self._scope = self.told.root
        if self._loop is self._ended_round:
            self._loop = None
        self._ended = self._ended_round = self._found_one = None

    def _at_most_of_them(self, part: ClausePart) -> bool:
        """ "..., but at most 8 trees": said of the round before it. Whether it is."""
        round_ = self._loop
        if round_ is None or part.places is None or part.relation is not None:
            return False
        found = find(part.places, self._site)
        if found.at_most is None or found.selector != s.Trees():
            return False
        if round_.at_most is not None or round_.optional:
            raise unclear(part.terms, message("the number is already given"), message("say it once"))
        round_.at_most = found.at_most
        round_.said += part.said
        return True

    def _round_of(self, captures: list[d.DraftCapture]) -> d.Loop | d.Times | None:
        """The innermost round that holds all of these captures."""
        for step, _ in reversed(list(d.walk(self.told.root))):
            if isinstance(step, d.Loop | d.Times):
                inside = [st for st, _ in d.walk(step.body)]
                if all(any(st is capture for st in inside) for capture in captures):
                    return step
        return None
