"""From parts to a plan: who "it" is, where "there" is, what "the same" was, and what an "if" holds.

The rules, each of which the documentation shows with an example:

* A command belongs to the "if" of its own sentence; a new sentence without an "if" goes back to the plan's own level.
* An "if" stands behind the capture whose reading it tests: an "if" on a reading that was itself conditional is nested.
* An "if" with no command behind it in its sentence holds the command before it ("measure CO2 if it is low").
* "If the battery allows" makes the commands behind it in its sentence optional; with none, the command before it.
* A command without a place is done where the command before it was; at several places, at each of them.
* "The same" is what was done at the last place: with its conditions, without the "if" that asks for the repetition.
"""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english import draft as d
from fieldhand.planning.english import repeating
from fieldhand.planning.english.areas import is_open, with_areas
from fieldhand.planning.english.asking import every_or_how_many
from fieldhand.planning.english.counting import Wanted, counts_each
from fieldhand.planning.english.ellipsis import Elliptic
from fieldhand.planning.english.faults import Question, idle_place, spans_of, text_of, unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.hand import ACTS as _ACTS
from fieldhand.planning.english.hand import said_of_places
from fieldhand.planning.english.lines import as_stops, points_over, stops_of
from fieldhand.planning.english.places import find
from fieldhand.planning.english.syntax import ClausePart
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.selections import says_how_many
from fieldhand.task.plan import Span

COMMANDS = (
    "act_on_objects",
    "act_on_places",
    "act_bare",
    "go",
    "visit",
    "come_back",
    "stop",
    "repeat",
    "lead",
    "more_objects",
    "more_places",
)


def _waits(following: tuple[ClausePart, ...]) -> bool:
    """Whether what follows a place is done there: it has none of its own."""
    return bool(following) and following[0].kind in _ACTS and following[0].places is None


def _goes_on(following: tuple[ClausePart, ...]) -> bool:
    """Whether a command stands right behind a condition, with nothing between: it is what the condition decides."""
    return bool(following) and following[0].bare and following[0].kind in COMMANDS and following[0].kind != "lead"


class Discourse(Elliptic):
    """Reads the parts of a request in order. One instance reads one request."""

    def read(self, parts: tuple[ClausePart, ...]) -> None:
        """Read one sentence.

        Raises:
            Unclear, Question: Something in it means nothing here, or several things.
        """
        parts = with_areas(parts, self._site)
        if parts[0].kind not in ("otherwise", "failing", "so"):
            self._scope = self.told.root
        self._sentence_steps = []
        self._sentence_acts = False
        if parts[0].kind != "otherwise":
            self._sentence_choices = []
        checked: tuple[Span, ...] = ()
        for index, part in enumerate(parts):
            following = self._following = parts[index + 1 :]
            match part.kind:
                case "act_bare" if len(part.terms) == 1 and following and following[0].kind == "question":
                    checked = part.said
                    continue  # "check | whether ..."
                case "condition":
                    before = [p for p in parts[:index] if p.kind in COMMANDS and p.kind != "lead"]
                    ahead = next((p.kind for p in following if p.kind not in ("budget", "order")), "")
                    ends = ahead in ("", "otherwise")
                    outer, trailing = self._scope, bool(before) and (ends or (part.bare and not _goes_on(following)))
                    self._condition(part, trailing=trailing)
                    if trailing and ahead not in ("", "otherwise"):
                        self._scope = outer  # "take a picture if it is low and then return": the return is for all
                case "until":
                    self._until(part)
                case "question":
                    self._condition(part, trailing=False)
                    if self._choice is not None:
                        self._choice.said += checked
                    self._scope = self.told.root
                case "so":
                    self._so(part)
                case "otherwise":
                    self._otherwise(part)
                case "failing":
                    self._failing(part)
                case "allowance":
                    self._allowance(part, parts, COMMANDS)
                case "budget":
                    self.told.limits.extend(t.value for t in part.terms)
                case "distinct":
                    self._distinct(part)
                case "order":
                    self._order(part)
                case "lead" if self._sentence_acts and not _waits(following):
                    self._read_command(replace(part, kind="more_places"))
                case "lead" if not any(p.kind in (*COMMANDS, "condition", "question") for p in following) or (
                    following[0].kind == "lead"
                ):
                    raise idle_place(part.terms)
                case _:
                    self._read_command(part)
        self._close_allowance()
        if self._pending is not None:
            raise unclear(
                [self._pending], message("an order needs several places"), message("say which places are visited in it")
            )

    def _read_command(self, part: ClausePart) -> None:
        if part.kind in ("come_back", "stop"):
            self._close_allowance()  # the way home and the end are for all
        self._after_until(part)
        self._after_otherwise(part)
        if part.kind == "lead":
            self._known_before_lead = self._known()
        before = {id(step) for step, _ in d.walk(self.told.root)}
        self._command(part)
        new = [step for step, _ in d.walk(self.told.root) if id(step) not in before]
        self._last_steps = new or self._last_steps
        self._sentence_steps += new
        self._sentence_acts = self._sentence_acts or part.kind in _ACTS

    def _command(self, part: ClausePart) -> None:
        match part.kind:
            case "more_objects" if self._says_again(part, self._wanted(part.objects, part)):
                pass
            case "act_on_objects" | "more_objects":
                self._act(part, self._wanted(part.objects, part))
            case "act_on_places":
                self._act_on_places(part)
            case "act_bare":
                self._act(part, self._wanted((), part))
            case "more_places":
                self._more_places(part)
            case "go" | "visit":
                self._go(part)
            case "lead":
                self._lead(part)
            case "come_back" if self._ends_a_series(part):
                self._act(replace(part, kind="more_places"), self._objects)
            case "come_back":
                self._come_back(part)
            case "stop":
                there = bool({"there", "here"} & set(text_of(part.terms).lower().split()))
                gone = bool(self._scope.steps) and isinstance(self._scope.steps[-1], d.Go)
                self._scope.add(d.Halt(said=part.said, here=there or gone))
            case "repeat":
                self._repeat(part)
        if part.kind not in ("lead",):
            self._last_verb = part.kind if part.kind not in ("more_places", "more_objects") else self._last_verb

    def _act_on_places(self, part: ClausePart) -> None:
        """ "Measure another tree for CO2", "photograph every tree", "take another"."""
        if part.objects:
            self._act(part, self._wanted(part.objects, part))
            return
        elided = self._elided(part)
        if elided is not None:
            self._act(elided[0], elided[1])
            return
        self._act(part, self._wanted((), part))

    def _more_places(self, part: ClausePart) -> None:
        """ "..., then the north-east corner": what was done before, there."""
        if self._at_each_of_them(part) or self._lists(part):
            return
        if self._last_verb in ("go", "visit"):
            self._go(part)
            return
        if self._last_verb == "repeat" and part.relation is not None:
            self._repeat(part)  # "repeat this at the first tree, and at the last one"
            return
        if not self._objects and all(t.kind == "NUM" for t in part.terms):
            self._objects = self._objects_of_case  # "take two pictures, otherwise just one"
        if not self._objects and self._captured_next():
            self._go(replace(part, kind="visit"))  # "Any 6 Kerman trees, a picture of each"
            return
        if not self._objects:
            raise idle_place(part.terms)
        if self._at_most_of_them(part):
            return
        elided = None if part.relation is not None else self._elided(part)
        if elided is not None:
            self._act(elided[0], elided[1])
            return
        if part.places is not None and part.relation is not None and find(part.places, self._site).region:
            last = [step for step, _ in d.walk(self.told.root) if isinstance(step, d.DraftCapture)]
            at = last[-1].at if last else None
            if self._loop is not None or at is None or at.any_of is None:  # "... and of row 4"
                raise every_or_how_many(part)
        self._act(part, self._objects)

    def _act(self, part: ClausePart, wanted: Wanted) -> None:
        """Captures at a place, at several, or where the robot is."""
        part, wanted = as_stops(part, wanted)
        found = None if part.places is None else self._related(part)
        there = any(t.kind == "THERE" for t in part.tails)
        if there and found is not None and found.selector == s.Take(count=1, of=s.Trees()) and self._at_one_place():
            found = replace(found, here=True)  # "go to the middle, take a picture of a tree there"
        if found is not None and not found.here and any(t.kind == "THERE" for t in part.tails):
            raise unclear(
                part.terms,
                message("it is not clear which of them"),
                message("name the trees, or say how many in one sentence"),
            )
        if found is not None and found.object_only and found.each:
            raise Question(message("'{said}': at each of which places?", context="question", said=text_of(part.terms)))
        if found is not None and found.object_only:  # "at yet another one"
            number = found.counted or 1
            found = FoundPlace(selector=s.Take(count=number, of=s.NotVisited()), many=number > 1, counted=number)
        if found is None and self._loop is None and any(t.kind == "ASMANY" for o in part.objects for t in o.quantity):
            found = FoundPlace(selector=s.Trees(), many=True)
        if found is not None and found.all_or_these and self._loop is not None:
            found = replace(found, here=True, these=True)
        found = self._lined(found, part, wanted)
        block, at, each = self._where(found, part, wanted)
        times = next((int(t.value) for t in part.tails if t.kind == "COUNT"), 1)
        self._commands += 1
        done: list[tuple[str, int]] = []
        in_rows = found is not None and found.rows and found.region  # "2 pictures in each row" are of two trees
        per_place = counts_each(found, part) and not in_rows
        for index, (action, count) in enumerate(wanted):
            captures = (1 if each and not per_place else count or 1) * times
            if len(wanted) == 1 and not per_place and self._spreads(block, captures):
                captures = 1
            said = spans_of([t for t in part.terms if not self._of_another(t, index, part)])
            step = d.DraftCapture(action=action, at=at if index == 0 else None, count=captures, said=said)
            step.command = self._commands
            step.at_said = said_of_places(part) if index == 0 and part.places is not None else ()
            block.add(step)
            done.append((action, captures))
        self._objects = tuple(done)

    def _lined(self, found: FoundPlace | None, part: ClausePart, wanted: Wanted) -> FoundPlace | None:
        """Places that are points: at a spacing, or spread over a zone; and trees of the rows that were gone to."""
        if part.spacing is not None:
            if found is not None and found.here:
                found = None
            found = stops_of(found, part, wanted, self._site)
            if self._loop is not None and self._loop in self._sentence_steps and not self._loop.body.steps:
                self._scope = self._loop.body  # "at each corner, take three measurements 15 m apart"
            return found
        if found is not None and part.relation is not None and part.relation.kind == "SPREAD":
            return points_over(found, part, wanted)
        said = part.places is not None and is_open(part.places)
        whole = found is not None and found.many and not found.selector.relative
        place = self._rows_gone_to or (self._area_gone_to if whole else "")
        if place and said and found is not None and not found.here:
            raise Question(
                message(
                    "'{said}': of {place}, or of the whole site?",
                    context="question",
                    said=text_of(part.terms),
                    place=place,
                ),
                (message("of {place}", context="answer", place=place), message("of the whole site", context="answer")),
                terms=part.places.terms if part.places is not None else (),
                words=(f"{text_of(part.places.terms)} of {place}", "") if part.places is not None else ("", ""),
            )
        return found

    def _of_another(self, term: Term, index: int, part: ClausePart) -> bool:
        """Whether a term names another capture of the same command."""
        return any(term in thing.terms for k, thing in enumerate(part.objects) if k != index) or term.kind == "JOIN"

    def _distinct(self, part: ClausePart) -> None:
        """ "Each at a different tree": what a number of captures in an area means anyway."""
        select = self._loop.select if self._loop is not None else None
        if self._loop is not None and self._loop.optional:
            self._loop.said += part.said  # each tree is visited once anyway
            return
        if select is None or not says_how_many(select):
            raise unclear(
                part.terms, message("it is not clear how many trees that are"), message("say how many trees, and where")
            )
        if self._loop is not None:
            self._loop.said += part.said

    def _order(self, part: ClausePart) -> None:
        if part.terms[0].kind == "ORDERED":
            if self._pending is not None:
                raise unclear(part.terms, message("the places cannot have two different orders"), message("say one"))
            if self._loop is not None and self._loop in self._sentence_steps:
                self._in_order(self._loop, part.terms[0])
                self._loop.said += part.said
            else:
                self._pending = part.terms[0]
            return
        if self._loop is not None:
            self._loop.order = "best"
            if part.terms[0].kind == "INORDER":
                self._one_after_the_other(self._loop)
            self._loop.said += part.said

    def _repeat(self, part: ClausePart) -> None:
        """ "Do the same": what was done at the last place, at the place that this sentence has gone to."""
        sentence = self._gone_to(part)
        old = [st for st in self.told.root.steps if id(st) not in sentence]
        if not old:  # "take a picture at A, then go to B and do the same": B is all that is new
            steps = self.told.root.steps
            split = len(steps) - 1 if steps and isinstance(steps[-1], d.Go) else len(steps)
            old, sentence = steps[:split], {id(st) for st in steps[split:]}
        passage = repeating.last_passage(old)
        if any(isinstance(step, d.Maybe) for step, _ in d.walk(passage)):
            raise unclear(
                part.terms,
                message("it is not clear whether that may be left out too"),
                message("say what is to be done again"),
            )
        times = next((int(t.value) for t in part.tails if t.kind == "COUNT"), None)
        if not passage.steps:
            raise unclear(part.terms, message("there is nothing before it to repeat"))
        made = repeating.copied(passage, lambda st: id(st) not in sentence, self._fresh)
        found = None if part.places is None else self._related(part)
        if found is not None and not found.here:
            if found.region and self._in_another_area(old, found, part):
                return
            found = repeating.as_many_as(old, found)
            repeating.without_place(made, part)
            if found.many:
                loop = self._add_loop(found, part)
                repeating.append(made, loop.body)
            else:
                self._scope.add(d.Go(place=found.selector, said=part.said))
                repeating.append(made, self._scope)
            return
        new = [st for st in self._scope.steps if id(st) in sentence] or (
            [self._loop] if self._loop is not None and id(self._loop) in sentence else []
        )
        if not new:
            if times is None:
                choices = (
                    message("at another tree", context="answer"),
                    message("at the same place", context="answer"),
                )
                raise Question(
                    message("'{said}': where?", context="question", said=text_of(part.terms)),
                    choices,
                    terms=part.terms,
                    words=(f"{text_of(part.terms)} at another tree", ""),
                )
            times = self._further(part, times)
            body = d.DraftBlock()
            repeating.append(made, body)
            self._scope.add(d.Times(times=times, body=body, said=part.said))
            return
        repeating.without_place(made, part)
        last = new[-1]
        last.said += part.said
        if isinstance(last, d.Loop):
            repeating.continue_with(made, last.body)
        else:
            repeating.continue_with(made, self._scope)
