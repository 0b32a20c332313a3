"""What is in hand while a request is read: the places, captures and cases that a word such as "it" may mean."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message, named
from fieldhand.language.words import COMPASS, listed
from fieldhand.places import selectors as s
from fieldhand.planning.english import draft as d
from fieldhand.planning.english.attributes import hinted
from fieldhand.planning.english.counting import Wanted, counted, number_of_objects
from fieldhand.planning.english.faults import Question, spans_of, text_of, unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.english.onebyone import counted_from
from fieldhand.planning.english.places import are_several, beyond, find
from fieldhand.planning.english.spacing import Ranking
from fieldhand.planning.english.syntax import ClausePart, Object
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.english.told import Told
from fieldhand.planning.selections import all_but, as_every_nth, is_spot, skips_rows, so_many_nearby, starts_here
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import Span
from fieldhand.terms import Side

#: Relations that say no more than where.
_PLAIN = ("OF", "AT", "FROM", "FOR", "INSIDE", "ALONG", "SPREAD")
#: Parts that ask for captures.
ACTS = ("act_on_objects", "act_on_places", "act_bare", "more_objects", "more_places")


def _counts(selector: s.Selector, side: str) -> bool:
    """Whether it takes every so many of a row or of the rows: where the count begins matters."""
    if (every := as_every_nth(selector)) is not None:
        return every.counted_from != side
    return skips_rows(selector)


def said_of_places(part: ClausePart) -> tuple[Span, ...]:
    """The words of a part that say where; all of them where nothing is captured in it."""
    if part.kind not in ACTS or part.places is None:
        return part.said
    ties = (part.relation, part.spacing)
    return spans_of([*part.places.terms, *part.tails, *(term for term in ties if term is not None)])


#: What a camera yields, and what is done with one whatever it yields ("shoot the corner trees").
_PICTURES = frozenset({"picture", "photo", "photograph", "image"})
_WITH_A_CAMERA = frozenset({"shoot", "shoots", "shot", "shooting", "snap", "snaps", "snapped", "snapping"})


class Hand:
    """What has been spoken of. One instance reads one request."""

    def __init__(self, robot: RobotProfile, site: Site) -> None:
        self.told = Told()
        self._robot, self._site = robot, site
        self._readings = 0
        self._commands = 0
        self._objects: tuple[tuple[str, int], ...] = ()  # actions and counts of the last command, for "another"
        self._objects_at_if: tuple[tuple[str, int], ...] = ()
        self._objects_of_case: tuple[tuple[str, int], ...] = ()  # the same of the case that an "otherwise" ends
        self._last_verb = ""
        self._aside: list[d.DraftCapture] = []  # held by an "if" behind them: a later "if it" does not mean them
        self._choice: d.Choice | None = None
        self._ended: d.Choice | None = None  # holds what is done where a round ends that "until" ends
        self._ended_round: d.Loop | d.Times | None = None
        self._found_one: d.Choice | None = None  # the same once it holds something
        self._following: tuple[ClausePart, ...] = ()  # what follows in the sentence
        self._sentence_choices: list[d.Step] = []
        self._pending: Term | None = None  # an order said before the places that it is about
        self._area_gone_to = ""  # the same of another area
        self._rows_gone_to = ""  # rows that a "go to" has named: of these, or of all, may "every tree" be said
        self._loop: d.Loop | None = None  # the places that "each of them" and "there" may mean
        self._listing: d.Loop | None = None  # whose places are named one by one behind a colon
        self._sentence_steps: list[d.Step] = []
        self._sentence_acts = False
        self._last_steps: list[d.Step] = []
        self._allowing: ClausePart | None = None  # "if the battery allows", until all that it is said of has been read
        self._allowed_after: frozenset[int] = frozenset()  # the steps that were there before
        self._known_before_lead: frozenset[int] = frozenset()
        self._allowances = 0  # that have been read
        self._scope = self.told.root

    def _where(
        self, found: FoundPlace | None, part: ClausePart, wanted: Wanted
    ) -> tuple[d.DraftBlock, s.Selector | None, bool]:
        """The block that captures belong to, the place they name, and whether that is one of several places."""
        there = any(t.kind == "THERE" for t in part.tails)
        if found is None or found.here or there:
            return self._here(part, found, there)
        found = counted(found, part, wanted)
        if not found.many:
            self._loop = None
            return self._scope, found.selector, False
        loop = self._add_loop(found, part)
        return loop.body, None, True

    def _here(
        self, part: ClausePart, found: FoundPlace | None, there: bool
    ) -> tuple[d.DraftBlock, s.Selector | None, bool]:
        """Captures without a place of their own."""
        these = (found is not None and found.these) or any(t.kind == "THERE" and are_several(t) for t in part.tails)
        if these:
            self._gather(part)
        loop = self._loop
        if loop is None or not self._within(loop.body, self.told.root):
            self._needs_place(part)
            return self._scope, None, False
        if self._within(self._scope, loop.body):
            return self._scope, None, False
        each = (found is not None and found.here) or there
        if not loop.body.steps or each or (loop in self._sentence_steps and not part.then):
            return loop.body, None, False
        raise Question(
            message(
                "'{said}': at each of the places before it, or only at the last one?",
                context="question",
                said=text_of(part.terms),
            ),
            (message("at each of them", context="answer"), message("only at the last one", context="answer")),
            terms=part.terms,
            words=(f"{text_of(part.terms)} at each of them", ""),
        )

    def _gather(self, part: ClausePart) -> None:
        """ "Each of them": places that were driven to one after the other become places to do something at."""
        if self._loop is not None:
            return
        stops: list[d.Go] = []
        for step in reversed(self._scope.steps):
            if not isinstance(step, d.Go):
                break
            stops.insert(0, step)
        if len(stops) < 2:
            raise unclear(
                part.terms, message("which places are meant?"), message("name them: 'at trees 4 and 9', for example")
            )
        self._scope.steps = self._scope.steps[: -len(stops)]
        said = tuple(span for stop in stops for span in stop.said)
        places = s.UnionOf(parts=tuple(stop.place for stop in stops))
        self._loop = d.Loop(select=places, body=d.DraftBlock(), order="given", said=said)
        self._scope.add(self._loop)

    def _add_loop(self, found: FoundPlace, part: ClausePart) -> d.Loop:
        given = any(t.kind == "INORDER" for t in part.tails)
        select = found.selector
        if taken := so_many_nearby(select.any_of, select.size.low):
            select = taken  # "go to trees nearby | and take two pictures"
        loop = d.Loop(
            select=select,
            body=d.DraftBlock(),
            order="given" if given else "best",
            optional=found.optional,
            at_most=found.at_most,
            said=said_of_places(part),
        )
        if given:
            self._one_after_the_other(loop)
        if self._pending is not None:
            loop.said = (*loop.said, self._pending.span)
            self._in_order(loop, self._pending)
            self._pending = None
        self._scope.add(loop)
        self._loop = loop
        return loop

    def _spreads(self, block: d.DraftBlock, captures: int) -> bool:
        """ "Go to nearby trees and take two pictures": at two trees, one each. Whether it is said so."""
        loop = self._loop
        if loop is None or block is not loop.body or loop.body.steps or captures < 2:
            return False
        nearby = so_many_nearby(loop.select, captures)
        if nearby is None:
            return False
        loop.select = nearby
        return True

    def _one_after_the_other(self, loop: d.Loop) -> None:
        """Visit the places of a loop as they are named; those of "the row" from where the robot is."""
        loop.order = "given"
        if loop.select.row_of == s.Here():
            loop.select = s.Ordered(by="nearest_first", of=loop.select)

    def _in_order(self, loop: d.Loop, term: Term) -> None:
        """Visit the places of a loop in an order that was said."""
        by, ranking, descending = term.value
        if loop.optional or loop.at_most is not None:
            raise unclear(
                [term],
                message("an order of places cannot be combined with a choice of how many"),
                message("leave one of them out"),
            )
        if isinstance(loop.select, s.Ordered):
            raise unclear([term], message("the places cannot have two different orders"), message("say one"))
        side: Side = "south" if str(by).startswith("south") else "east" if str(by).startswith("east") else "north"
        if side in ("south", "east") and any(_counts(part, side) for part in loop.select.walk()):
            if not any(skips_rows(part) for part in loop.select.walk()):
                loop.select = counted_from(loop.select, side)
                counts = message("'{said}': they are counted from there, too.", context="assumption", said=term.text)
                self.told.assumptions.append(counts)
                loop.select = s.Ordered(by=by, descending=descending, of=loop.select)
                loop.order = "given"
                return
            from_side = COMPASS[side]
            choices = (
                message("counted from the {side}", context="answer", side=from_side),
                message("visited from the {side}", context="answer", side=from_side),
            )
            raise Question(
                message(
                    "'{said}': is it counted from there, or only visited from there?",
                    context="question",
                    said=term.text,
                ),
                choices,
            )
        attribute = ""
        if isinstance(ranking, Ranking):
            attribute = self._ranked_by(ranking, term)
        loop.select = s.Ordered(by=by, attribute=attribute, descending=descending, of=loop.select)
        loop.order = "given"

    def _ranked_by(self, ranking: Ranking, term: Term) -> str:
        if not ranking.said:
            begins = message("'{said}' begins with the lowest.", context="assumption", said=term.text)
            self.told.assumptions.append(begins)
        if isinstance(ranking.attribute, str):
            return hinted(ranking.attribute, (term,), self._site)
        if len(ranking.attribute) > 1:
            raise Question(
                message(
                    "'{said}': which of {attribute}?",
                    context="question",
                    said=term.text,
                    attribute=listed(ranking.attribute),
                ),
                tuple(ranking.attribute),
            )
        return str(ranking.attribute[0])

    def _within(self, block: d.DraftBlock | None, outer: d.DraftBlock) -> bool:
        while block is not None:
            if block is outer:
                return True
            block = block.parent
        return False

    def _needs_place(self, part: ClausePart) -> None:
        """Something done "there" needs a place that was spoken of; "here" is where the robot stands."""
        if any(t.kind == "THERE" and t.text.lower() == "here" for t in part.terms):
            return
        if not any(isinstance(step, d.Go | d.DraftCapture | d.Loop) for step, _ in d.walk(self.told.root)):
            raise Question(message("'{said}': at which tree or trees?", context="question", said=text_of(part.terms)))

    def _related(self, part: ClausePart) -> FoundPlace:
        """The places of a part, with the relation that ties them to its verb."""
        if part.places is None:
            raise unclear(part.terms, message("a place was expected"))
        found = self._one_of_two(part) or find(part.places, self._site)
        beside = isinstance(found.selector, s.Adjacent) and found.selector.near == s.Here()
        beside = beside and self._sentence_acts and not part.then
        if beside and isinstance(found.selector, s.Adjacent) and any(t.kind == "NEARBY" for t in part.places.terms):
            # "Tree 60 and two neighbouring trees": neighbours of it, not of each other.
            nearest = s.Nearest(to=s.Here(), count=found.selector.count, fresh=True, of=found.selector.of)
            found = replace(found, selector=nearest)
        relation = part.relation
        self._check_rows(found, part)
        if relation is not None and relation.kind == "ALONG" and not found.line:
            raise unclear(part.terms, message("along which row?"), message("name the row: 'along row 3'"))
        if relation is not None and relation.kind == "FROM" and found.rows:
            raise unclear(
                part.terms, message("from there, but what?"), message("say 'in row 3', or 'starting with row 3'")
            )
        if relation is None or found.here or relation.kind in _PLAIN:
            return found
        plain = find(part.places, self._site).selector
        match relation.kind:
            case "NEXTTO" if found.many:
                return found  # "the soil beside four trees": at each of them
            case "NEXTTO":
                return FoundPlace(selector=s.Nearest(to=plain, adjacent=True))
            case "NEAR" if is_spot(plain):
                return found
            case "NEAR":
                return FoundPlace(selector=s.Nearest(to=plain))
            case "WITHIN":
                return FoundPlace(selector=s.Within(distance_m=relation.value, to=plain), many=True, region=True)
            case "BEYOND":
                away = s.Excluding(places=beyond(relation.value, plain))
                return FoundPlace(selector=away, many=True, region=True)
            case "OUTSIDE" | "EXCEPT":
                return FoundPlace(selector=all_but(plain), many=True, region=True)
            case _:
                raise unclear(part.terms, message("'{said}' does not fit there", said=relation.text))

    def _one_of_two(self, part: ClausePart) -> FoundPlace | None:
        """ "The southern one": of the two places that were spoken of last, the one that is farther to that side."""
        phrase = part.places.chains[0].phrases[0] if part.places is not None else None
        terms = [] if phrase is None or part.places is None else [t for group in phrase.nominals for t in group]
        whole = part.places is not None and len(part.places.terms) == len(phrase.terms if phrase else ())
        if not whole or [t.kind for t in terms] != ["DIR", "PLACE"] or len(str(terms[0].value)) < 3:
            return None
        spoken: list[s.Selector] = []
        for step, _ in d.walk(self.told.root):
            place = step.place if isinstance(step, d.Go) else step.at if isinstance(step, d.DraftCapture) else None
            known = place is None or place.named_marker or place in spoken
            if place is not None and not known and place.single and not place.relative:
                spoken.append(place)
        if len(spoken) < 2:
            return None
        return FoundPlace(selector=s.Extreme(side=terms[0].value, of=s.UnionOf(parts=tuple(spoken[-2:]))))

    def _check_rows(self, found: FoundPlace, part: ClausePart) -> None:
        """ "5 trees down", "that row", "across the aisle": from a tree that has been spoken of."""
        self.told.assumptions += found.assumed
        first = part.places.chains[0].phrases[0].terms if part.places is not None else ()
        step = next((t for t in first if t.kind == "STEP"), None)
        of_it = part.relation is None or part.relation.kind == "OF"
        if step is not None and step.value.bare and of_it and part.kind in ACTS:
            number = step.value.trees
            raise Question(
                message(
                    "'{said}': the tree that is {number} trees along, or {number} trees there?",
                    context="question",
                    said=text_of(part.terms),
                    number=number,
                ),
                (
                    message("the tree {said}", context="answer", said=step.text),
                    message("{number} trees", context="answer", number=number),
                ),
                terms=(step,),
            )
        if not any(starts_here(part_) for part_ in found.selector.walk()):
            return
        if not any(isinstance(step, d.Go | d.DraftCapture | d.Loop) for step, _ in d.walk(self.told.root)):
            said = text_of(part.terms)
            asked = (
                message("'{said}': which row?", context="question", said=said)
                if found.rows
                else message("'{said}': from which tree?", context="question", said=said)
            )
            raise Question(asked)

    def _at_one_place(self) -> bool:
        """Whether the last step went to one place, of which "a tree there" can be said."""
        last = self._scope.steps[-1] if self._scope.steps else None
        return isinstance(last, d.Go) and not last.place.named_marker

    def _fresh(self) -> str:
        self._readings += 1
        return f"r{self._readings}"

    def _wanted(self, objects: tuple[Object, ...], part: ClausePart) -> Wanted:
        """The actions that a command asks for, each with its number if one is said."""
        if objects:
            return tuple((self._action(o.noun, part), number_of_objects(o)) for o in objects)
        verb = part.verb
        if verb is not None and isinstance(verb.value, Naming):
            return ((verb.value.actions[0], None),)
        cameras = [a.name for a in self._robot.actions if _PICTURES & set(a.words)]
        if verb is not None and len(cameras) == 1 and verb.text.lower().split()[0] in _WITH_A_CAMERA:
            return ((cameras[0], None),)
        one = any(t.kind == "NUM" and t.value == 1 for t in part.terms)
        before = self._objects or (self._objects_of_case if one else ())  # "..., otherwise take one there"
        if before:
            return tuple((action, None) for action, _ in before)
        if len(self._robot.actions) == 1:
            return ((self._robot.actions[0].name, None),)
        names = tuple(_thing(a.words[0]) for a in self._robot.actions if a.words)
        words = tuple(f"take a {name} of" if part.relation is None else f"take a {name}" for name in names)
        terms = () if verb is None or part.places is None or part.tails else (verb,)
        raise Question(
            message("'{said}': what should be taken?", context="question", said=text_of(part.terms)),
            names,
            terms=terms,
            words=words if terms else (),
        )

    def _action(self, noun: Term, part: ClausePart) -> str:
        if noun.kind == "READING":
            measuring = [a for a in self._robot.actions if a.measures]
            if len(measuring) == 1:
                return measuring[0].name
            if self._objects:
                return self._objects[-1][0]
            names = tuple(_thing(a.words[0]) for a in measuring if a.words)
            raise Question(
                message("'{said}': a reading of what?", context="question", said=text_of(part.terms)),
                names,
                terms=(noun,),
            )
        naming: Naming = noun.value
        if not naming.actions:
            raise unclear(
                part.terms, message("{name} has no action for '{said}'", name=self._robot.name, said=noun.text)
            )
        return naming.actions[0]


def _thing(word: str) -> str:
    """Return what an action takes, as a choice to answer with."""
    return named(word, "answer", named(word, "capture"))
