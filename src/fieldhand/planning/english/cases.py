"""What an "if", an "otherwise" and an "if that fails" hold, and which reading an "if" tests."""

from __future__ import annotations

from collections.abc import Iterable

from fieldhand.language import message
from fieldhand.language.words import say_action
from fieldhand.places import selectors as s
from fieldhand.planning.english import draft as d
from fieldhand.planning.english.asking import choices_of_actions
from fieldhand.planning.english.attributes import number_of
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.hand import ACTS, Hand
from fieldhand.planning.english.places import find
from fieldhand.planning.english.several import Share, one_after_another, share_of
from fieldhand.planning.english.syntax import ClausePart, parse_places
from fieldhand.planning.english.tested import Predicate, place_in, quantities_of, read_condition
from fieldhand.planning.english.tokens import Term
from fieldhand.task import conditions as c
from fieldhand.task.conditions import readings
from fieldhand.task.plan import Span


def _spans(said: Iterable[tuple[Span, ...]]) -> tuple[Span, ...]:
    return tuple(dict.fromkeys(span for spans in said for span in spans))


class Cases(Hand):
    """Reads conditions."""

    def _condition(self, part: ClausePart, *, trailing: bool) -> None:
        """An "if": it stands behind what it tests, and holds what follows it, or what stands before it."""
        held = self._last_steps if trailing else []
        if part.terms[0].value == "where" and not trailing:
            self._gather_captures()
        captures = [(step, block) for step, block in d.walk(self.told.root) if isinstance(step, d.DraftCapture)]
        self._objects_at_if = self._objects
        known = [cap for cap, _ in captures if cap not in held and not (trailing and cap in self._aside)]
        terms, place = place_in(part.terms[1:])
        at = self._place_tested(place, part)
        if at is not None:
            known = [cap for cap in known if cap.at == at]
        self._check_it(terms, known, part)
        share = share_of(terms)
        if share is not None and not (share.loose and self._done_there()):
            self._of_several(share, known, part, held)
            return
        terms = terms if share is None else share.terms
        tested = read_condition(terms, known, self._robot, self._site)
        made = [self._tested_capture(p, at, part, trailing) for p in tested.predicates]
        block = self._block_of_condition([cap for cap in made if cap is not None], part)
        names = [self._bound(cap) for cap in made]
        condition = tested.condition(names)
        if part.terms[0].value == "unless":
            condition = c.Not(condition=condition)
        choice = d.Choice(condition=condition, then=d.DraftBlock(), said=part.said)
        if trailing and any(cap is None for cap in made):
            self._hold_at_tree(held, choice, part)
            return
        block.add(choice)
        if trailing:
            self._aside += [step for step in held if isinstance(step, d.DraftCapture)]
            self._move(held, choice.then)
        self._choice = choice
        self._sentence_choices.append(choice)
        self._scope = choice.then

    def _done_there(self) -> bool:
        """Whether what follows in the sentence is done where the reading was taken."""
        ahead = next((p for p in self._following if p.kind not in ("budget", "order")), None)
        if ahead is None:
            return False
        places = None if ahead.places is None else self._related(ahead)
        return ahead.kind in ACTS and (places is None or places.here)

    def _of_several(self, share: Share, known: list[d.DraftCapture], part: ClausePart, held: list[d.Step]) -> None:
        """ "If both are low": a condition on several readings, each of them taken by itself."""
        captures = self._captures_of(share, known, part)
        each = []
        for capture in captures:
            tested = read_condition(share.terms, [capture], self._robot, self._site)
            each.append(tested.condition([self._bound(capture) for _ in tested.predicates]))
        if share.least is not None and share.least > len(each):
            raise unclear(
                part.terms, message("there are only {count} readings", count=len(each)), message("say how many of them")
            )
        condition = share.of(each)
        if part.terms[0].value == "unless":
            condition = c.Not(condition=condition)
        choice = d.Choice(condition=condition, then=d.DraftBlock(), said=part.said)
        self._block_of_condition(captures, part).add(choice)
        if held:
            self._move(held, choice.then)
        self._loop = None
        self._choice, self._scope = choice, choice.then
        self._sentence_choices.append(choice)

    def _captures_of(self, share: Share, known: list[d.DraftCapture], part: ClausePart) -> list[d.DraftCapture]:
        """The captures whose readings a condition on several is about."""
        last = read_condition(share.terms, known, self._robot, self._site).predicates[0].capture
        if last is None:
            raise unclear(part.terms, message("nothing before it measures that"), message("measure first, then test"))
        for loop, holder in d.walk(self.told.root):
            if isinstance(loop, d.Loop) and any(step is last for step in loop.body.steps):
                at = loop.body.steps.index(last)
                blocks = one_after_another(loop, holder, self._site, part.terms)
                found = [[st for st in block.steps if not isinstance(st, d.Go)][at] for block in blocks]
                captures = [st for st in found if isinstance(st, d.DraftCapture)]
                break
        else:
            block = next(b for step, b in d.walk(self.told.root) if step is last)
            alike = [
                st for st in block.steps if isinstance(st, d.DraftCapture) and st.action == last.action and st in known
            ]
            captures = alike if share.size is None else alike[-share.size :]
        if len(captures) < 2 or (share.size is not None and len(captures) != share.size):
            what = message("{count} readings of that are taken before it", count=len(captures))
            raise unclear(part.terms, what, message("say which readings are meant"))
        return captures

    def _gather_captures(self) -> None:
        """ "At the north-west corner and at tree 9 ... Wherever it is low": the captures before it become a round."""
        steps = self.told.root.steps
        run: list[d.DraftCapture] = []
        for step in reversed(steps):
            alike = isinstance(step, d.DraftCapture) and step.at is not None and not step.reading
            if (
                not isinstance(step, d.DraftCapture)
                or not alike
                or (run and (step.action, step.count) != (run[0].action, run[0].count))
            ):
                break
            run.insert(0, step)
        if len(run) < 2 or any(step.at is not None and step.at.relative for step in run):
            return
        body = d.DraftBlock(
            steps=[d.DraftCapture(action=run[0].action, count=run[0].count, said=_spans(step.said for step in run))]
        )
        places = s.UnionOf(parts=tuple(step.at for step in run if step.at is not None))
        loop = d.Loop(select=places, body=body, order="given", said=_spans(step.at_said for step in run))
        del steps[-len(run) :]
        self.told.root.add(loop)
        self._loop = loop

    def _hold_at_tree(self, held: list[d.Step], choice: d.Choice, part: ClausePart) -> None:
        """What a tree is can be asked once the robot is there: drive first, then test, then do."""
        first = held[0] if held else None
        if isinstance(first, d.Loop):
            choice.then.steps, first.body.steps = first.body.steps, []
            for step in choice.then.steps:
                for inner in d.blocks_of(step):
                    inner.parent = choice.then
            first.body.add(choice)
        elif isinstance(first, d.DraftCapture) and all(isinstance(step, d.DraftCapture) for step in held):
            holder = next(b for step, b in d.walk(self.told.root) if step is first)
            if first.at is not None:
                holder.steps.insert(holder.steps.index(first), d.Go(place=first.at, said=first.said))
                first.at = None
            holder.add(choice)
            self._move(held, choice.then)
        else:
            raise unclear(
                part.terms,
                message("it is not clear at which tree"),
                message("say 'go to tree 4; if it is yellow, ...'"),
            )
        self._choice, self._scope = choice, choice.then

    def _check_it(self, terms: tuple[Term, ...], known: list[d.DraftCapture], part: ClausePart) -> None:
        """ "If it is low, ... If it is high, ...": the second "it" may be what the first case took."""
        if self._same_test(terms, known):
            return
        says_which = any(t.kind in ("NOUN", "ORD", "AMOUNT", "READING", "ATTR", "ATTRVAL", "STILL") for t in terms)
        if says_which or self._choice is None or not readings(self._choice.condition):
            return
        inside = [cap for cap in known if any(cap is st for st, _ in d.walk(self._choice.then))]
        wanted = set(quantities_of(terms, (), self._robot))
        inside = [cap for cap in inside if set(self._robot.action[cap.action].measures) & wanted]
        before = [cap for cap in known if cap.reading in readings(self._choice.condition)]
        fitting = [cap for cap in known if set(self._robot.action[cap.action].measures) & wanted]
        if fitting and not any(fitting[-1] is cap for cap in (*inside, *before)):
            return  # what was taken after both of them is meant
        if inside and before and not any(t.kind == "CMP" and t.value[1] for t in terms):
            if self._continues(terms, known, before):
                return
            names = choices_of_actions(cap.action for cap in (*before, *inside))
            if len(names) > 1:  # of two readings of a kind, the later one
                raise Question(
                    message("'{said}': which reading is meant?", context="question", said=text_of(part.terms)), names
                )

    def _same_test(self, terms: tuple[Term, ...], known: list[d.DraftCapture]) -> bool:
        """ "If it's not below 33 °C, ...; if it is below 33 °C, ...": two cases of one reading. Whether they are."""
        before = self._choice.condition if self._choice is not None else None
        before = before.condition if isinstance(before, c.Not) else before
        numbers = [number_of(t) for t in terms if t.kind in ("NUM", "AMOUNT")]
        named = any(t.kind in ("NOUN", "ORD", "STILL") for t in terms)
        negated = any(t.kind in ("NOT", "ISNOT") for t in terms)
        opposite = self._choice is not None and isinstance(self._choice.condition, c.Not) != negated
        if named or not isinstance(before, c.Compare):
            return False
        tests = [t.value[0] for t in terms if t.kind == "CMP"]
        if not opposite and (tests == [before.test] or self._choice not in self._sentence_choices):
            return False  # the same test again is of what was taken since
        if numbers != [before.value]:
            return False
        tested = [cap for cap in known if cap.reading == before.reading]
        known[:] = tested or known
        return bool(tested)

    def _continues(self, terms: tuple[Term, ...], known: list[d.DraftCapture], before: list[d.DraftCapture]) -> bool:
        """Whether the words tell by themselves which of two readings is meant.

        "If it is low, ..., if it is high, ..." are two cases of one reading; "when that is low as well" is another.
        What was taken inside the first case is left out of what may be meant, in the first case.
        """
        said = self._choice.condition if self._choice is not None else None
        level = next((str(t.value) for t in terms if t.kind == "LEVEL"), "")
        if not isinstance(said, c.Level) or not level or any(t.kind in ("NOT", "ISNOT") for t in terms):
            return False
        if level != said.level and self._choice in self._sentence_choices:
            names = {cap.action for cap in before}
            known[:] = [cap for cap in known if cap.action in names]
            other = message(
                "'{said}' is another case of the reading that was tested before.",
                context="assumption",
                said=text_of(terms),
            )
            self.told.assumptions.append(other)
            return True
        return any(t.kind == "IT" and t.text.lower() in ("that", "that one") for t in terms)

    def _place_tested(self, terms: tuple[Term, ...], part: ClausePart) -> s.Selector | None:
        """The place that a condition names ("the CO2 at tree 4")."""
        if not terms:
            return None
        places = parse_places(terms[1:])
        if places is None or terms[0].kind not in ("AT", "OF", "FROM", "NEXTTO", "NEAR", "INSIDE"):
            raise unclear(
                part.terms, message("it is not clear where"), message("measure there first, then say 'if it is ...'")
            )
        found = find(places, self._site)
        if found.many or found.object_only:
            raise unclear(
                part.terms,
                message("a condition has to be about one place"),
                message("say 'at each of them ..., if it is ...'"),
            )
        if found.here:
            return None
        if terms[0].kind in ("NEXTTO", "NEAR"):
            return s.Nearest(to=found.selector, adjacent=terms[0].kind == "NEXTTO")
        return found.selector

    def _tested_capture(
        self, predicate: Predicate, at: s.Selector | None, part: ClausePart, trailing: bool
    ) -> d.DraftCapture | None:
        """The capture whose reading a predicate tests; taken first if nothing took it."""
        if not predicate.missing:
            if predicate.capture is None:
                self._needs_place(part)
            return predicate.capture
        if trailing:
            raise unclear(part.terms, message("nothing before it measures that"), message("measure first, then test"))
        if at is None:
            self._needs_place(part)
        capture = d.DraftCapture(action=predicate.missing, at=at, said=part.said)
        (self._scope if at is not None else self._here(part, None, False)[0]).add(capture)
        said, action = text_of(part.terms), say_action(predicate.missing)
        there = message("'{said}' is measured first ({action}), there.", context="assumption", said=said, action=action)
        then = message(
            "'{said}' is measured first ({action}), where the robot is then.",
            context="assumption",
            said=said,
            action=action,
        )
        self.told.assumptions.append(there if at is not None else then)
        return capture

    def _block_of_condition(self, captures: list[d.DraftCapture], part: ClausePart) -> d.DraftBlock:
        """Where a condition stands: behind the last of what it tests, where the others are known too."""
        if not captures:
            inside = self._loop is not None and self._within(self._loop.body, self.told.root)
            return self._loop.body if inside and self._loop is not None else self._scope
        holders = [(cap, block) for cap, block in d.walk(self.told.root) if any(cap is c for c in captures)]
        block = holders[-1][1]
        if not all(self._within(block, holder) for _, holder in holders):
            raise unclear(
                part.terms,
                message("its readings are not taken in the same case"),
                message("test them one after the other"),
            )
        return block

    def _bound(self, capture: d.DraftCapture | None) -> str:
        if capture is None:
            return ""
        capture.reading = capture.reading or self._fresh()
        return capture.reading

    def _so(self, part: ClausePart) -> None:
        """ "If so": the question before it is answered with yes."""
        if self._choice is None or self._choice.then.steps:
            raise unclear(part.terms, message("there is no question before it"))
        self._choice.said += part.said
        self._scope = self._choice.then

    def _otherwise(self, part: ClausePart) -> None:
        choice = self._choice
        if choice is None:
            raise unclear(part.terms, message("there is no 'if' before it"))
        if choice.otherwise is not None:
            raise unclear(part.terms, message("the 'if' before it already has an 'otherwise'"))
        holder = next((b for st, b in d.walk(self.told.root) if st is choice), None)
        at = holder.steps.index(choice) if holder is not None else 0
        if holder is not None and at and isinstance(holder.steps[at - 1], d.Choice) and part.said:
            earlier = holder.steps[at - 1]
            if earlier in self._sentence_choices and choice in self._sentence_choices:
                raise unclear(
                    part.terms,
                    message("to which 'if' does it belong?"),
                    message("say each 'if' with its 'otherwise' in turn"),
                )
        choice.said += part.said
        choice.otherwise = d.DraftBlock(parent=choice.then.parent)
        if self._loop is not None and self._within(self._loop.body, choice.then):  # of the other case
            around = [st for st, _ in d.walk(self.told.root) if isinstance(st, d.Loop) and self._holds(st, choice)]
            self._loop = around[-1] if around else None
        if self._objects != self._objects_at_if:
            self._objects_of_case = self._objects
            self._objects = ()  # "otherwise take another" may mean what either case takes
        self._scope = choice.otherwise

    def _after_otherwise(self, part: ClausePart) -> None:
        """ "Otherwise read the temperature, then go to tree 9": what comes then is for both cases.

        With "and then" it goes on with the second; and where that only drives so far, it does so with "then" too.
        """
        block = self._scope
        choice = self._choice
        if choice is None or block is not choice.otherwise or not part.then or part.joined:
            return
        if not any(isinstance(step, d.DraftCapture) for step, _ in d.walk(block)) or block.parent is None:
            return
        self._scope = block.parent
        both = message("'{said}' is done in both cases.", context="assumption", said=text_of(part.terms))
        self.told.assumptions.append(both)

    def _holds(self, loop: d.Loop, choice: d.Choice) -> bool:
        return any(step is choice for step, _ in d.walk(loop.body))

    def _failing(self, part: ClausePart) -> None:
        steps = list(self._last_steps)
        if not steps:
            raise unclear(part.terms, message("there is nothing before it that could fail"))
        holder = next(b for st, b in d.walk(self.told.root) if st is steps[0])
        attempt = d.Attempt(body=d.DraftBlock(), fallback=d.DraftBlock(), said=part.said)
        place = holder.steps.index(steps[0])
        self._move(steps, attempt.body)
        holder.steps.insert(place, attempt)
        attempt.body.parent = attempt.fallback.parent = holder
        self._scope = attempt.fallback

    def _move(self, steps: list[d.Step], into: d.DraftBlock) -> None:
        inner = {id(st) for step in steps for b in d.blocks_of(step) for st, _ in d.walk(b)}
        for step in steps:
            if id(step) in inner:
                continue
            holder = next(b for st, b in d.walk(self.told.root) if st is step)
            holder.steps.remove(step)
            into.add(step)
