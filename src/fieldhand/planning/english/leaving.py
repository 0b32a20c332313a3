"""Steps that may be left out: which of them "if the battery allows" is said of."""

from __future__ import annotations

from fieldhand.language import message
from fieldhand.planning.english import draft as d
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.motion import Motion
from fieldhand.planning.english.syntax import ClausePart
from fieldhand.planning.selections import refers_to_here

#: Words that do not say what must be enough.
_BUDGET_UNSAID = frozenset({"if possible", "if at all possible", "where possible", "if feasible", "optionally"})


class Leaving(Motion):
    """Reads what makes steps optional.

    Behind a command it is said of that command, before commands of all that follow it in the sentence, a stop and the
    way home left out.
    """

    def _allowance(self, part: ClausePart, parts: tuple[ClausePart, ...], commands: tuple[str, ...]) -> None:
        """Make the last command optional, or, where it stands before commands, remember from where on they are."""
        self._close_allowance()
        index = next(k for k, one in enumerate(parts) if one is part)
        self._allowed_after = self._known_before_lead if index and parts[index - 1].kind == "lead" else self._known()
        self._said_of_loop(part, self._allowed_after)
        before = [p for p in parts[:index] if p.kind in commands and p.kind != "lead"]
        ahead = [p for p in parts[index + 1 :] if p.kind not in ("budget", "order", "distinct")]
        ends = not ahead or ahead[0].kind in ("otherwise", "failing", "come_back", "stop")
        if (
            before
            and not ends
            and not part.bare
            and not (part.joined or part.then)
            and (ahead[0].joined or ahead[0].then)
        ):
            said, first, last = text_of(part.terms), text_of(before[-1].terms), text_of(ahead[0].terms)
            raise Question(
                message(
                    "'{said}': does that apply to '{first}' or to '{last}'?",
                    context="question",
                    said=said,
                    first=first,
                    last=last,
                ),
                (first, last),
            )
        if ahead and ahead[0].kind == "more_places" and all(t.kind == "NUM" for t in ahead[0].terms):
            number = text_of(ahead[0].terms)
            asked = message(
                "'{number}': tree {number}, or {number} of what was said before?", context="question", number=number
            )
            tree = message("tree {number}", context="answer", number=number)
            raise Question(asked, (tree,), terms=ahead[0].terms)
        self._allowances += 1
        self._choice = None  # an "otherwise" behind it does not answer an earlier "if"
        self._allowing = part
        said = text_of(part.terms)
        if said.lower() in _BUDGET_UNSAID:
            taken = message(
                "'{said}' is taken as: if the battery and the budget allow it.", context="assumption", said=said
            )
            self.told.assumptions.append(taken)
        if before and (ends or part.bare):
            self._leave_out(list(self._last_steps))
            self._allowing = None

    def _said_of_loop(self, part: ClausePart, known: frozenset[int]) -> None:
        """ "At every yellow tree, if the battery allows, ...": it can be said of the round, or of each visit."""
        if any(isinstance(step, d.Loop) for step, _ in d.walk(self.told.root) if id(step) not in known):
            advice = message("say 'at as many of them as you can', or begin the sentence with it")
            raise unclear(
                part.terms, message("does it apply to all these places together, or to each of them?"), advice
            )

    def _otherwise(self, part: ClausePart) -> None:
        if self._choice is None and self._allowances:
            what = message("a step that the budget does not allow is left out; nothing can replace it")
            raise unclear(part.terms, what, message("leave the 'otherwise' out"))
        super()._otherwise(part)

    def _close_allowance(self) -> None:
        """What it is said of ends here."""
        if self._allowing is not None:
            known = self._allowed_after
            self._leave_out([step for step, _ in d.walk(self.told.root) if id(step) not in known])
            self._allowing = None

    def _leave_out(self, steps: list[d.Step]) -> None:
        """Make steps one optional step, where they stand."""
        part = self._allowing
        if part is None:
            return
        chosen = {id(step) for step in steps}
        placed = [(step, block) for step, block in d.walk(self.told.root) if id(step) in chosen]
        inner = {id(st) for step, _ in placed for b in d.blocks_of(step) for st, _ in d.walk(b)}
        outer = [(step, block) for step, block in placed if id(step) not in inner]
        if not outer:
            raise unclear(
                part.terms, message("it does not say what may be left out"), message("say what is to be done then")
            )
        holder = outer[0][1]
        at = holder.steps.index(outer[0][0])
        whole = [step for step, _ in outer]
        if holder.steps[at : at + len(whole)] != whole:
            raise unclear(
                part.terms, message("it is not clear what may be left out"), message("say it in a sentence of its own")
            )
        if len(whole) == 1 and isinstance(whole[0], d.Loop) and whole[0].optional:
            whole[0].said += part.said
            return  # "as many as you can, if the battery allows" is said twice
        if any(isinstance(step, d.Halt) for step in whole):
            raise unclear(
                part.terms,
                message("the way home and the end of the mission are never left out"),
                message("leave it out"),
            )
        if any(self._may_be_left_out(step) for step, _ in placed) or self._inside_optional(holder):
            advice = message("apply it to only one of the two")
            raise unclear(part.terms, message("what it applies to may already be left out"), advice)
        if any(isinstance(step, d.Loop) for step, _ in placed):
            said = text_of(part.terms)
            self.told.assumptions.append(
                message(
                    "'{said}' applies to the whole: all of it is done, or all of it is left out.",
                    context="assumption",
                    said=said,
                )
            )
        made = d.Maybe(body=d.DraftBlock(), said=part.said)
        del holder.steps[at : at + len(whole)]
        for step in whole:
            made.body.add(step)
        holder.add(made)
        holder.steps.insert(at, holder.steps.pop())

    def _may_be_left_out(self, step: d.Step) -> bool:
        return isinstance(step, d.Maybe) or (isinstance(step, d.Loop) and step.optional)

    def _inside_optional(self, block: d.DraftBlock) -> bool:
        return any(
            self._may_be_left_out(step) and any(self._within(block, inner) for inner in d.blocks_of(step))
            for step, _ in d.walk(self.told.root)
        )

    def _known(self) -> frozenset[int]:
        return frozenset(id(step) for step, _ in d.walk(self.told.root))


def place_unsure(block: d.DraftBlock) -> d.Step | None:
    """The first step whose place hangs on whether a step before it is left out; None where there is none."""
    try:
        _follow(block, False)
    except _Unsure as found:
        return found.step
    return None


class _Unsure(Exception):
    """A step was found. No error: it ends the search."""

    def __init__(self, step: d.Step) -> None:
        self.step = step
        super().__init__()


def _follow(block: d.DraftBlock, unsure: bool) -> bool:
    """Go through the steps of a block; whether it is unsure where the robot is, before and after."""
    for step in block.steps:
        match step:
            case d.Go(place=place) | d.DraftCapture(at=place) | d.Loop(select=place):
                if unsure and (place is None or refers_to_here(place)):
                    raise _Unsure(step)
                unsure = False
                if isinstance(step, d.Loop):
                    _follow(step.body, False)
            case d.Maybe():
                unsure = _follow(step.body, unsure) or unsure or any(_goes(inner) for inner, _ in d.walk(step.body))
            case _:
                unsure = any([_follow(inner, unsure) for inner in d.blocks_of(step)] or [unsure])
    return unsure


def _goes(step: d.Step) -> bool:
    return isinstance(step, d.Go | d.Loop) or (isinstance(step, d.DraftCapture) and step.at is not None)
