"""Where a request sends the robot: drives, places of what follows, and the way home."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english import draft as d
from fieldhand.planning.english import repeating
from fieldhand.planning.english.faults import text_of, unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.places import find
from fieldhand.planning.english.syntax import ClausePart
from fieldhand.planning.english.told import Homeward
from fieldhand.planning.english.until import Until
from fieldhand.task.frames import Then


class Motion(Until):
    """Reads commands that move the robot."""

    def _go(self, part: ClausePart) -> None:
        if part.places is None:
            self.told.no_part += part.said
            return
        if self._sentence_steps and part.verb is not None and part.verb.text.lower() in ("starting", "beginning"):
            raise unclear(
                part.terms,
                message("where to begin has to be said before the work"),
                message("name the first tree first"),
            )
        found = self._related(part)
        self._rows_gone_to = self._area_gone_to = ""
        if found.here and part.kind != "visit":
            self.told.no_part += part.said
            return
        if found.rows and found.region and part.kind != "visit":
            self._go_to_rows(found, part)
            return
        if found.object_only:
            found = FoundPlace(
                selector=s.Take(count=found.counted or 1, of=s.NotVisited()), many=(found.counted or 1) > 1
            )
        if found.region and part.kind != "visit":
            self._area_gone_to = text_of(part.places.terms)
            found = FoundPlace(selector=found.selector if found.selector.named_marker else self._one_of(found.selector))
        if (
            found.selector == s.Marker(name="start")
            and not self.told.root.steps
            and part.relation is not None
            and (part.relation.kind == "FROM" or part.kind == "go")
        ):
            self.told.no_part += part.said
            return  # a mission starts there anyway
        if found.many:
            self._add_loop(found, part)
            return
        self._loop = None
        self._scope.add(d.Go(place=found.selector, said=part.said))

    def _go_to_rows(self, found: FoundPlace, part: ClausePart) -> None:
        """ "Go to row 3": to the tree of it that is nearest."""
        if part.relation is not None and part.relation.kind == "ALONG":
            advice = message("say it in one sentence: 'drive down row 3 and take a picture of every tree'")
            raise unclear(part.terms, message("it does not say what to do along the row"), advice)
        if found.each or found.one_by_one:
            raise unclear(
                part.terms, message("it does not say what to do in each row"), message("say it in the same sentence")
            )
        self._rows_gone_to = text_of(part.places.terms) if part.places is not None else ""
        self._loop = None
        self._scope.add(d.Go(place=s.Take(count=1, of=found.selector), said=part.said))

    def _one_of(self, area: s.Selector) -> s.Selector:
        """A tree to drive to when an area is named: the one in its middle."""
        return s.Middle(of=area)

    def _lead(self, part: ClausePart) -> None:
        """ "At each corner, ...": the place of what follows."""
        if part.relation is not None and part.relation.kind == "FROM" and not self.told.root.steps:
            found = self._related(part)
            if found.selector == s.Marker(name="start"):
                self.told.no_part += part.said
                return
        if part.relation is not None and part.relation.kind == "EXCEPT":
            raise unclear(part.terms, message("an exception has to follow directly after what it restricts"))
        found = self._related(part)
        if found.object_only:
            raise unclear(part.terms, message("a place was expected"))
        self._go(replace(part, kind="visit"))

    def _come_back(self, part: ClausePart) -> None:
        self._rows_gone_to = self._area_gone_to = ""
        then, place = self._home(part)
        if self._scope is self.told.root and not self.told.root.steps and place is None:
            self.told.nominal = then  # "come back when done: photograph tree 5"
            self.told.nominal_said += part.said
            self.told.first = True
        elif self._scope is self.told.root:
            self.told.nominal = then
            if place is not None:
                self._scope.add(d.Go(place=place, said=part.said))
                self.told.nominal = "stay"
            else:
                self._scope.add(Homeward(said=part.said, then=then))
        else:
            marker = place or s.Marker(name="start" if then == "return_to_start" else "end")
            self.told.ends_differ = self.told.ends_differ or self.told.in_case not in (
                None,
                then if place is None else "",
            )
            self.told.in_case = then if place is None else None
            if self._scope.steps and isinstance(self._scope.steps[-1], d.Halt):
                self._scope.steps[-1].said += part.said
            else:
                self._scope.add(d.Go(place=marker, said=part.said))
        self._loop = None

    def _marker_spoken_of(self) -> str:
        """The marker that the request named last; empty if it named none."""
        places = [at for step, _ in d.walk(self.told.root) if (at := repeating.selects(step)) is not None]
        names = [part.named_marker for at in places for part in at.walk() if part.named_marker]
        return names[-1] if names else ""

    def _home(self, part: ClausePart) -> tuple[Then, s.Selector | None]:
        if part.places is not None:
            selector = find(part.places, self._site).selector
            if selector == s.Marker(name="start"):
                return "return_to_start", None
            if selector == s.Marker(name="end"):
                return "return_to_end", None
            if selector == s.Here():  # "come back to it": to the marker that was spoken of, else to the start
                return ("return_to_end" if self._marker_spoken_of() == "end" else "return_to_start"), None
            return "stay", selector
        if "start" in self._site.markers or "end" not in self._site.markers:
            said = text_of(part.terms)
            self.told.assumptions.append(message("'{said}' means back to the start.", context="assumption", said=said))
            return "return_to_start", None
        return "return_to_end", None
