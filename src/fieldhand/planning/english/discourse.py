"""From parts to a plan: who "it" is, where "there" is, what "the same" was, and what an "if" holds.

The rules, each of which the documentation shows with an example:

* A command belongs to the "if" of its own sentence; a new sentence without an "if" goes back to the plan's own level.
* An "if" stands behind the capture whose reading it tests: so an "if" on a reading that was itself conditional is nested.
* An "if" with no command behind it in its sentence holds the command before it ("measure CO2 if it is low").
* A command without a place is done where the command before it was; at several places, at each of them.
* "The same" is what was done at the last place: with its conditions, without the "if" that asks for the repetition.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from fieldhand.planning.english import draft as d
from fieldhand.planning.english.arrange import Limit
from fieldhand.planning.english.lexicon import Naming
from fieldhand.planning.english.places import Found, Question, Unclear, find
from fieldhand.planning.english.syntax import Object, Part
from fieldhand.planning.english.tested import read_condition
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.planner import Reason
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import selectors as s
from fieldhand.task.frames import Then


@dataclass
class Told:
    """What a request says, as far as it has been read.

    Attributes:
        root: The plan's own level.
        limits: Budgets and reserves.
        nominal: Where the robot is to end, if the request says it.
        assumptions: What was assumed, as sentences.
    """

    root: d.Block = field(default_factory=d.Block)
    limits: list[Limit] = field(default_factory=list)
    nominal: Then | None = None
    assumptions: list[str] = field(default_factory=list)


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


class Discourse:
    """Reads the parts of a request in order. One instance reads one request."""

    def __init__(self, robot: RobotProfile, site: Site) -> None:
        self.told = Told()
        self._robot, self._site = robot, site
        self._readings = 0
        self._objects: tuple[tuple[str, int], ...] = ()  # actions and counts of the last command, for "another"
        self._last_verb = ""
        self._choice: d.Choice | None = None
        self._loop: d.Loop | None = None  # the places that "each of them" and "there" may mean
        self._sentence_steps: list[d.Step] = []
        self._last_steps: list[d.Step] = []
        self._scope = self.told.root

    def read(self, parts: tuple[Part, ...]) -> None:
        """Read one sentence.

        Raises:
            Unclear, Question: Something in it means nothing here, or several things.
        """
        if not (parts and parts[0].kind in ("otherwise", "failing")):
            self._scope = self.told.root
        self._sentence_steps = []
        for index, part in enumerate(parts):
            following = parts[index + 1 :]
            match part.kind:
                case "condition":
                    before = [p for p in parts[:index] if p.kind in COMMANDS and p.kind != "lead"]
                    ahead = next((p.kind for p in following if p.kind not in ("budget", "order")), "")
                    self._condition(part, trailing=bool(before) and ahead in ("", "otherwise"))
                case "otherwise":
                    self._otherwise(part)
                case "failing":
                    self._failing(part)
                case "budget":
                    self.told.limits.extend(t.value for t in part.terms)
                case "order":
                    self._order(part)
                case _:
                    steps_before = {id(step) for step, _ in d.walk(self.told.root)}
                    self._command(part)
                    new = [st for st, _ in d.walk(self.told.root) if id(st) not in steps_before]
                    self._last_steps = new or self._last_steps
                    self._sentence_steps += new

    # Commands

    def _command(self, part: Part) -> None:
        match part.kind:
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
            case "come_back":
                self._come_back(part)
            case "stop":
                self._scope.add(d.Halt(said=part.said))
            case "repeat":
                self._repeat(part)
        if part.kind not in ("lead",):
            self._last_verb = part.kind if part.kind not in ("more_places", "more_objects") else self._last_verb

    def _act_on_places(self, part: Part) -> None:
        """ "Measure another tree for CO2", "photograph every tree", "take another"."""
        if part.objects:
            self._act(part, self._wanted(part.objects, part))
            return
        assert part.places is not None
        found = find(part.places, self._site)
        objects = self._wanted((), part)
        if found.object_only:
            objects = tuple((action, found.counted or count) for action, count in objects[:1])
            first = part.places.chains[0]
            where = replace(part, places=None, relation=None)
            if len(first.phrases) > 1:
                rest = replace(first, phrases=first.phrases[1:], relations=first.relations[1:])
                where = replace(
                    part,
                    places=replace(part.places, chains=(rest, *part.places.chains[1:])),
                    relation=first.relations[0],
                )
            self._act(where, objects)
            return
        self._act(part, objects)

    def _more_places(self, part: Part) -> None:
        """ "..., then the north-east corner": what was done before, there."""
        if self._last_verb in ("go", "visit"):
            self._go(part)
            return
        if not self._objects:
            raise self._unclear(part, "it does not say what to do there")
        self._act(part, self._objects)

    def _act(self, part: Part, wanted: tuple[tuple[str, int | None], ...]) -> None:
        """Captures at a place, at several, or where the robot is."""
        found = None if part.places is None else self._related(part)
        block, at, each = self._where(found, part, wanted)
        times = next((int(t.value) for t in part.tails if t.kind == "COUNT"), 1)
        done: list[tuple[str, int]] = []
        for index, (action, count) in enumerate(wanted):
            captures = (1 if each and not self._counts_each(found, part) else count or 1) * times
            step = d.Capture(action=action, at=at if index == 0 else None, count=captures, said=part.said)
            block.add(step)
            done.append((action, captures))
        self._objects = tuple(done)

    def _related(self, part: Part) -> Found:
        """The places of a part, with the relation that ties them to its verb."""
        assert part.places is not None
        found = find(part.places, self._site)
        self.told.assumptions += found.assumptions
        relation = part.relation
        if relation is None or found.here or relation.kind in ("OF", "AT", "FROM", "FOR", "WITH", "INSIDE"):
            return found
        plain = find(part.places, self._site).selector
        match relation.kind:
            case "NEXTTO":
                return Found(selector=s.Nearest(to=plain, adjacent=True))
            case "NEAR" if isinstance(plain, s.Middle | s.EdgeMiddle):
                return found
            case "NEAR":
                return Found(selector=s.Nearest(to=plain))
            case "WITHIN":
                return Found(selector=s.Within(distance_m=relation.value, to=plain), many=True, region=True)
            case "OUTSIDE" | "EXCEPT":
                other = replace(plain, outside=True) if isinstance(plain, s.InZone) else s.Excluding(places=plain)
                return Found(selector=other, many=True, region=True)
            case _:
                raise self._unclear(part, f"'{relation.text}' does not fit there")

    def _counts_each(self, found: Found | None, part: Part) -> bool:
        """Whether a count is meant at each place ("2 pictures at each corner") rather than in all."""
        return (found is not None and found.each) or any(t.kind == "EACHTAIL" for t in part.tails)

    def _where(
        self, found: Found | None, part: Part, wanted: tuple[tuple[str, int | None], ...]
    ) -> tuple[d.Block, s.Selector | None, bool]:
        """The block that captures belong to, the place they name, and whether that is one of several places."""
        there = any(t.kind == "THERE" for t in part.tails)
        if found is None or found.here or there:
            return self._here(part, found, there)
        found = self._counted(found, part, wanted)
        if not found.many:
            self._loop = None
            return self._scope, found.selector, False
        loop = self._add_loop(found, part)
        return loop.body, None, True

    def _counted(self, found: Found, part: Part, wanted: tuple[tuple[str, int | None], ...]) -> Found:
        """A number of captures and a kind of place: "2 pictures of nearby trees" are two trees."""
        count = wanted[0][1] if wanted else None
        plural = bool(part.objects) and part.objects[0].noun.plural
        as_many = any(t.kind == "ASMANY" for o in part.objects for t in o.quantity)
        if as_many:
            return replace(found, many=True, optional=True)
        if found.each or found.optional or found.at_most is not None or self._counts_each(found, part):
            return found
        if found.region:
            if count is None and plural:
                return found if not isinstance(found.selector, s.Trees) else self._ask_how_many(part)
            number = count or 1
            return Found(selector=s.Take(count=number, of=found.selector), many=number > 1, counted=number)
        if found.many and found.counted is None and count is not None and count > 1:
            selector = found.selector
            if isinstance(selector, s.Nearest):
                return replace(found, selector=replace(selector, count=count), counted=count)
            if isinstance(selector, s.Corners | s.Union):
                size = len(selector.which) if isinstance(selector, s.Corners) else len(selector.parts)
                if size == count:
                    return found
                raise Question(
                    f"{count} captures at {size} places: {count} at each, or {count} in all?",
                    (f"{count} at each", f"{count} in all"),
                )
            return Found(selector=s.Take(count=count, of=selector), many=True, counted=count)
        if found.many and found.counted is not None and count is not None and count not in (1, found.counted):
            raise Question(
                f"{count} captures at {found.counted} trees: {count} at each of them, or {count} in all?",
                (f"{count} at each of them", f"{count} in all"),
            )
        if found.many and found.counted is None and isinstance(found.selector, s.Nearest):
            raise Question("how many trees nearby?", ("2", "3", "4"))
        return found

    def _ask_how_many(self, part: Part) -> Found:
        raise Question(f"'{self._text(part)}': at every tree, or at how many?", ("at every tree", "at 4 trees"))

    def _add_loop(self, found: Found, part: Part) -> d.Loop:
        given = any(t.kind == "INORDER" for t in part.tails)
        loop = d.Loop(
            select=found.selector,
            body=d.Block(),
            order="given" if given else "best",
            optional=found.optional,
            at_most=found.at_most,
            reward=found.reward,
            said=part.said,
        )
        self._scope.add(loop)
        self._loop = loop
        return loop

    def _here(self, part: Part, found: Found | None, there: bool) -> tuple[d.Block, s.Selector | None, bool]:
        """Captures without a place of their own."""
        loop = self._loop
        if loop is None or not self._within(loop.body, self.told.root):
            return self._scope, None, False
        if self._within(self._scope, loop.body):
            return self._scope, None, False
        each = (found is not None and found.here) or there
        if not loop.body.steps or each or (loop in self._sentence_steps and not part.then):
            return loop.body, None, bool(found is not None and found.each)
        raise Question(
            f"'{self._text(part)}': at each of the places before it, or only at the last one?",
            ("at each of them", "only at the last one"),
        )

    def _within(self, block: d.Block | None, outer: d.Block) -> bool:
        while block is not None:
            if block is outer:
                return True
            block = block.parent
        return False

    def _go(self, part: Part) -> None:
        if part.places is None:
            return
        found = self._related(part)
        if found.here and part.kind != "visit":
            return
        if found.object_only:
            found = Found(selector=s.Take(count=found.counted or 1, of=s.Other()), many=(found.counted or 1) > 1)
        if found.region and part.kind != "visit":
            found = Found(
                selector=found.selector if isinstance(found.selector, s.Marker) else self._one_of(found.selector)
            )
        if (
            found.selector == s.Marker(name="start")
            and not self.told.root.steps
            and part.relation is not None
            and (part.relation.kind == "FROM" or part.kind == "go")
        ):
            return  # a mission starts there anyway
        if found.many:
            self._add_loop(found, part)
            return
        self._loop = None
        self._scope.add(d.Go(place=found.selector, said=part.said))

    def _one_of(self, area: s.Selector) -> s.Selector:
        """A tree to drive to when an area is named: the one in its middle."""
        return s.Middle(of=area)

    def _lead(self, part: Part) -> None:
        """ "At each corner, ...": the place of what follows."""
        assert part.places is not None
        if part.relation is not None and part.relation.kind == "FROM" and not self.told.root.steps:
            found = self._related(part)
            if found.selector == s.Marker(name="start"):
                return
        if part.relation is not None and part.relation.kind == "EXCEPT":
            raise self._unclear(part, "an exception must stand right behind what it is taken from")
        found = self._related(part)
        if found.object_only:
            raise self._unclear(part, "a place was expected")
        self._go(replace(part, kind="visit"))

    def _come_back(self, part: Part) -> None:
        then, place = self._home(part)
        if self._scope is self.told.root:
            self.told.nominal = then
            self._exit_place = place
            if place is not None:
                self._scope.add(d.Go(place=place, said=part.said))
                self.told.nominal = "stay"
            else:
                self._scope.add(_Exit(said=part.said, then=then))
        else:
            marker = place or s.Marker(name="start" if then == "return_to_start" else "end")
            self._scope.add(d.Go(place=marker, said=part.said))
        self._loop = None

    def _home(self, part: Part) -> tuple[Then, s.Selector | None]:
        if part.places is not None:
            selector = find(part.places, self._site).selector
            if selector == s.Marker(name="start"):
                return "return_to_start", None
            if selector == s.Marker(name="end"):
                return "return_to_end", None
            return "stay", selector
        if "start" in self._site.markers or "end" not in self._site.markers:
            self.told.assumptions.append(f"'{self._text(part)}' means back to the start.")
            return "return_to_start", None
        return "return_to_end", None

    # Conditions

    def _condition(self, part: Part, *, trailing: bool) -> None:
        captures = [(step, block) for step, block in d.walk(self.told.root) if isinstance(step, d.Capture)]
        held = self._last_steps if trailing else []
        if trailing:
            captures = [(cap, block) for cap, block in captures if cap not in held]
        tested = read_condition(part.terms[1:], captures, self._robot, self._site)
        block = self._scope
        capture = tested.capture
        if tested.missing:
            if trailing:
                raise self._unclear(part, "nothing before it measures that", "measure first, then test")
            capture = d.Capture(action=tested.missing, said=part.said)
            block = self._here(part, None, False)[0]
            block.add(capture)
            self.told.assumptions.append(
                f"'{self._text(part)}' is measured first ({tested.missing.replace('_', ' ')}), where the robot is then."
            )
        elif capture is not None:
            block = next(b for cap, b in captures if cap is capture)
        elif self._loop is not None and self._within(self._loop.body, self.told.root):
            block = self._loop.body
        if capture is not None and not capture.reading:
            self._readings += 1
            capture.reading = f"r{self._readings}"
        choice = d.Choice(
            condition=tested.condition(capture.reading if capture is not None else ""), then=d.Block(), said=part.said
        )
        block.add(choice)
        if trailing:
            self._move(held, choice.then)
        self._choice = choice
        self._scope = choice.then

    def _move(self, steps: list[d.Step], into: d.Block) -> None:
        inner = {id(st) for step in steps for b in d.blocks_of(step) for st, _ in d.walk(b)}
        for step in steps:
            if id(step) in inner:
                continue
            holder = next(b for st, b in d.walk(self.told.root) if st is step)
            holder.steps.remove(step)
            into.add(step)

    def _otherwise(self, part: Part) -> None:
        choice = self._choice
        if choice is None:
            raise self._unclear(part, "there is no 'if' before it")
        if choice.otherwise is not None:
            raise self._unclear(part, "the 'if' before it has an 'otherwise' already")
        choice.otherwise = d.Block(parent=choice.then.parent)
        self._scope = choice.otherwise

    def _failing(self, part: Part) -> None:
        steps = [st for st in self._last_steps]
        if not steps:
            raise self._unclear(part, "there is nothing before it that could fail")
        holder = next(b for st, b in d.walk(self.told.root) if st is steps[0])
        attempt = d.Attempt(body=d.Block(), fallback=d.Block(), said=part.said)
        place = holder.steps.index(steps[0])
        self._move(steps, attempt.body)
        holder.steps.insert(place, attempt)
        attempt.body.parent = attempt.fallback.parent = holder
        self._scope = attempt.fallback

    def _order(self, part: Part) -> None:
        if self._loop is not None:
            self._loop.order = "given" if part.terms[0].kind == "INORDER" else "best"

    # Repeating

    def _repeat(self, part: Part) -> None:
        """ "Do the same": what was done at the last place, at the place that this sentence has gone to."""
        sentence = {id(step) for step in self._sentence_steps}
        old = [st for st in self.told.root.steps if id(st) not in sentence]
        times = next((int(t.value) for t in part.tails if t.kind == "COUNT"), None)
        start = next((i for i in range(len(old) - 1, -1, -1) if _has_place(old[i])), 0)
        passage = d.Block(steps=old[start:])
        if not passage.steps:
            raise self._unclear(part, "there is nothing before it to repeat")
        made = d.copy_block(passage, lambda st: id(st) not in sentence, {}, self._fresh)
        found = None if part.places is None else self._related(part)
        if found is not None and not found.here:
            self._without_place(made, part)
            if found.many:
                loop = self._add_loop(found, part)
                self._append(made, loop.body)
            else:
                self._scope.add(d.Go(place=found.selector, said=part.said))
                self._append(made, self._scope)
            return
        new = [st for st in self._scope.steps if id(st) in sentence] or (
            [self._loop] if self._loop is not None and id(self._loop) in sentence else []
        )
        if not new:
            if times is None:
                raise Question(f"'{self._text(part)}': where?", ("at another tree", "at the same place"))
            body = d.Block()
            self._append(made, body)
            self._scope.add(d.Times(times=times, body=body, said=part.said))
            return
        self._without_place(made, part)
        last = new[-1]
        if isinstance(last, d.Loop):
            self._continue(made, last.body)
        else:
            self._continue(made, self._scope)

    def _continue(self, made: d.Block, scope: d.Block) -> None:
        """Append a copied passage; its first capture may have been asked for again at the new place."""
        first = made.steps[0]
        last = scope.steps[-1] if scope.steps else None
        if isinstance(first, d.Capture) and isinstance(last, d.Capture) and last.action == first.action:
            if first.reading:
                last.reading = last.reading or first.reading
                names = {first.reading: last.reading}
                for step, _ in d.walk(made):
                    if isinstance(step, d.Choice):
                        step.condition = d.rename(step.condition, names)
            made.steps = made.steps[1:]
        self._append(made, scope)

    def _append(self, made: d.Block, scope: d.Block) -> None:
        for step in made.steps:
            scope.add(step)

    def _without_place(self, made: d.Block, part: Part) -> None:
        """A copied passage begins at the new place instead of its own."""
        first = made.steps[0]
        match first:
            case d.Go():
                made.steps = made.steps[1:]
                if not made.steps:
                    raise self._unclear(part, "there is nothing before it to repeat")
            case d.Capture():
                first.at = None
            case d.Loop(select=s.Adjacent() as select):
                first.select = replace(select, near=s.Here())
            case d.Loop(select=s.Nearest() as select):
                first.select = replace(select, to=s.Here())
            case d.Loop(body=body):
                made.steps = [*body.steps, *made.steps[1:]]
            case _:
                pass

    def _fresh(self) -> str:
        self._readings += 1
        return f"r{self._readings}"

    # Words

    def _wanted(self, objects: tuple[Object, ...], part: Part) -> tuple[tuple[str, int | None], ...]:
        """The actions that a command asks for, each with its number if one is said."""
        if objects:
            return tuple((self._action(o.noun, part), _count(o)) for o in objects)
        verb = part.verb
        if verb is not None and isinstance(verb.value, Naming):
            return ((verb.value.actions[0], None),)
        if self._objects:
            return tuple((action, None) for action, _ in self._objects)
        if len(self._robot.actions) == 1:
            return ((self._robot.actions[0].name, None),)
        raise Question(
            f"'{self._text(part)}': what should be taken?", tuple(a.words[0] for a in self._robot.actions if a.words)
        )

    def _action(self, noun: Term, part: Part) -> str:
        if noun.kind == "READING":
            measuring = [a for a in self._robot.actions if a.measures]
            if len(measuring) == 1:
                return measuring[0].name
            if self._objects:
                return self._objects[-1][0]
            raise Question(f"'{self._text(part)}': a reading of what?", tuple(a.words[0] for a in measuring if a.words))
        naming: Naming = noun.value
        if not naming.actions:
            raise self._unclear(part, f"{self._robot.name} has no action for '{noun.text}'")
        return naming.actions[0]

    def _text(self, part: Part) -> str:
        return " ".join(t.text for t in sorted(part.terms, key=lambda t: t.start) if t.text)

    def _unclear(self, part: Part, what: str, advice: str = "say it in other words") -> Unclear:
        return Unclear(Reason(what=f"'{self._text(part)}': {what}", said=part.said, advice=advice))


@dataclass(eq=False)
class _Exit(d.Halt):
    """A return that the request asks for at the plan's own level: the nominal exit if nothing follows it, else a drive."""

    then: Then = "return_to_end"


def settle_exits(told: Told) -> None:
    """Make the returns of the plan's own level drives, but for the last, which is the nominal exit.

    Returns:
        None; ``told`` is changed.
    """
    steps = told.root.steps
    for index, step in enumerate(steps):
        if isinstance(step, _Exit) and index < len(steps) - 1:
            steps[index] = d.Go(
                place=s.Marker(name="start" if step.then == "return_to_start" else "end"), said=step.said
            )
            told.nominal = None
    if steps and isinstance(steps[-1], _Exit):
        told.nominal = steps[-1].then
        steps.pop()
    while len(steps) > 1 and type(steps[-1]) is d.Halt:
        steps.pop()  # a plan ends at its end


def _has_place(step: d.Step) -> bool:
    match step:
        case d.Go() | d.Loop():
            return True
        case d.Capture(at=at):
            return at is not None
        case d.Attempt(body=body):
            return bool(body.steps) and _has_place(body.steps[0])
        case _:
            return False


def _count(thing: Object) -> int | None:
    number = next((int(t.value) for t in thing.quantity if t.kind == "NUM"), None)
    if number is None and any(t.kind in ("DET", "ANOTHER") for t in thing.quantity) and not thing.noun.plural:
        return None
    return number
