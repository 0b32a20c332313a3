"""The meaning of the clauses of a request together: pure functions from a state and a clause to the next state.

The rules:

* A command belongs to the condition of its own sentence; a new sentence without a condition goes back to the plan
  itself.
* A condition tests the last reading of its quantity, and stands behind the capture that takes it.
* A condition with no command behind it in its sentence decides the command before it.
* A command without a place is done where the command before it was; at several places, at each of them.

``clauses`` reads clause by clause (:func:`read_clauses`) and leaves each kind of command to ``capturing``, ``driving``,
``conditions`` or ``allowances``. ``state`` and ``plans`` have the state and what is done with the plan in it;
``turns`` makes corrections and puts steps told out of order in their order, ``fragments`` makes commands of parts
that name only places or only captures; ``fitting`` decides how many visits and
captures a place means, and ``tested`` which reading a test is about.

Where a request leaves open what is meant ("a picture of row 3": of each tree, or of one?), a function takes the way
that :meth:`Setting.either` returns; :func:`read_in_each_way` reads the clauses once for each way, and the plans that
come of them are the answers that a person can choose from.
"""

from __future__ import annotations

from fieldhand.planning.grammar.dialogue.clauses import read_clauses, read_in_each_way
from fieldhand.planning.grammar.dialogue.plans import whole_plan
from fieldhand.planning.grammar.dialogue.state import DialogueState, Edits, NotComposed, OpenQuestion, Setting

__all__ = [
    "DialogueState",
    "Edits",
    "NotComposed",
    "OpenQuestion",
    "Setting",
    "read_clauses",
    "read_in_each_way",
    "whole_plan",
]
