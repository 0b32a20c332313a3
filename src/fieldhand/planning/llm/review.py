"""Parse a model's document into a draft, or into problems described so that the model can correct them.

The checks are the schema, then references inside the plan, then the site (unknown zones, selectors without trees).
Approval repeats all of them for every planner; they run early here because a model can repair its plan without
involving the operator.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

from fieldhand.errors import PlaceError, TaskError
from fieldhand.places.context import Context
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Bound, InRow
from fieldhand.planning.foreseen import foreseeable
from fieldhand.planning.llm.quotes import place_quotes
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.model import Place, Site
from fieldhand.task import conditions, plan
from fieldhand.task.capabilities import Capabilities
from fieldhand.task.codec import TaskDraft, decode_draft
from fieldhand.task.codec_shapes import NAMESPACE, element_name
from fieldhand.task.codec_xml import line_of, parse_xml
from fieldhand.task.conditions import TreeHas
from fieldhand.task.frames import Command, Composition, Task
from fieldhand.task.plan import Node
from fieldhand.task.references import references
from fieldhand.task.schema import validate

if TYPE_CHECKING:
    from lxml.etree import _Element

#: Advice addressed to the author of the request, on which a model must not act.
_TO_A_PERSON = re.compile(r"(?:ask|say|name|give|add|count from)\b")

ProblemKind = Literal["answer", "schema", "words", "reference", "site", "coordinate", "request"]


@dataclass(frozen=True, kw_only=True)
class AnswerProblem:
    """A reason why an answer is unusable.

    Attributes:
        kind: ``answer``: no readable document; ``schema``: invalid document; ``words``: quoted words missing from the
            request; ``reference``: an unbound name; ``site``: something that the site lacks; ``coordinate``: an
            invented position; ``request``: a contradiction with the request.
        where: Line and element; empty if the problem has no position in the document.
        truncated: True if the answer ended before its document did.
    """

    kind: ProblemKind
    message: str
    where: str = ""
    truncated: bool = False

    def __str__(self) -> str:
        return f"[{self.kind}] " + (f"{self.where}: " if self.where else "") + self.message


def read_draft(document: str, capabilities: Capabilities, request: str = "") -> TaskDraft | tuple[AnswerProblem, ...]:
    """Return the draft that a document contains, or the problems of its form.

    Node ids give the position in the document (``line 12 <act>``), for later messages;
    ``task.build.make_task`` assigns the final ids. Ids and ranges written by the model are ignored: it quotes words of
    the request, whose positions are found here.
    """
    data = _with_namespace(document).encode()
    invalid = validate(data, capabilities, draft=True)
    if invalid:
        return tuple(
            AnswerProblem(
                kind="schema", message=p.message, where=f"line {p.line}" + (f" <{p.element}>" if p.element else "")
            )
            for p in invalid
        )
    root = parse_xml(data)
    unsaid = place_quotes(root, request)
    if unsaid:
        return tuple(AnswerProblem(kind="words", message=message, where=where) for where, message in unsaid)
    try:
        return decode_draft(_with_lines(root))
    except TaskError as error:
        return (AnswerProblem(kind="schema", message=_error_text(error), where=error.where),)


def review(draft: TaskDraft, site: Site, capabilities: Capabilities) -> tuple[AnswerProblem, ...]:
    """Return the problems of a draft with references and with the site, without duplicates."""
    bare = Task(id="draft", command=Command(request=""), composition=Composition(plan=draft.plan))
    unbound = [AnswerProblem(kind="reference", message=message) for message in references(bare, capabilities)]
    return tuple(dict.fromkeys([*unbound, *_places(draft.plan, site)]))


def _with_namespace(document: str) -> str:
    """Add the namespace that small models omit; there is only one, so the meaning does not change."""
    opening = document[: document.find(">") + 1]
    if re.search(r"\sxmlns\s*=", opening):
        return document
    return re.sub(r"^<task\b", f'<task xmlns="{NAMESPACE}"', document, count=1)


def _with_lines(root: _Element) -> bytes:
    """Return the document with the position of each node as its unique id."""
    from lxml import etree

    nodes = {f"{{{NAMESPACE}}}{element_name(cls)}" for cls in get_args(Node)}
    used: dict[str, int] = {}
    for element in root.iter(*nodes):
        name = f"line {line_of(element)} <{etree.QName(element).localname}>"
        used[name] = used.get(name, 0) + 1
        element.set("id", name if used[name] == 1 else f"{name} no. {used[name]}")
    encoded: bytes = etree.tostring(root, encoding="UTF-8")
    return encoded


def _places(root: Node, site: Site) -> Iterator[AnswerProblem]:
    """Yield the problems of selectors and conditions with the site."""
    known = {phrase(name) for name in site.attributes}
    for node in plan.walk(root):
        selector = node.selector
        if selector is not None:
            on_ground = node.work is not None and node.work.on_ground
            yield from _unresolved(selector, site, node.id, on_ground=on_ground)
            if not node.visits_each:
                yield from _more_than_one(selector, site, node.id)
        if node.rewarded_by and phrase(node.rewarded_by) not in known:
            yield _no_attribute(node.rewarded_by, site, node.id)
        condition = node.tested
        for part in conditions.walk(condition) if condition is not None else ():
            if isinstance(part, TreeHas) and phrase(part.attribute) not in known:
                yield _no_attribute(part.attribute, site, node.id)


def _unresolved(selector: Selector, site: Site, where: str, *, on_ground: bool) -> Iterator[AnswerProblem]:
    """Yield the problems of the largest parts that can be resolved before the mission starts: places, or ground."""
    from fieldhand.places.resolution import Resolution

    for part in foreseeable(selector):
        try:
            if on_ground:
                part.ground(Resolution(site, Context(here=site.start)))
            else:
                _resolve(part, site)
        except PlaceError as error:
            yield AnswerProblem(kind="site", message=_error_text(error), where=where)


def _more_than_one(selector: Selector, site: Site, where: str) -> Iterator[AnswerProblem]:
    """Yield a problem if an action or drive has several places, which require a for-each or a choice of one."""
    if selector.single or isinstance(selector, Bound) or _one_of_a_row(selector):
        return
    if not selector.relative:
        try:
            if len(_resolve(selector, site)) == 1:
                return
        except PlaceError:
            return  # already reported
    name = element_name(type(selector))
    message = f'<{name}> gives several places where one is needed: use a <for-each>, or <take count="1">'
    yield AnswerProblem(kind="site", message=message, where=where)


def _one_of_a_row(selector: Selector) -> bool:
    """Return True if the selector is one tree by its number in the row of one place."""
    of = selector.of if isinstance(selector, InRow) and selector.first == selector.last else None
    return of is not None and of.row_of is not None and of.row_of.single


def _resolve(selector: Selector, site: Site) -> tuple[Place, ...]:
    from fieldhand.places.resolution import resolve

    return resolve(selector, site, Context(here=site.start))


def _no_attribute(name: str, site: Site, where: str) -> AnswerProblem:
    known = ", ".join(list(site.attributes)[:20]) or "none"
    return AnswerProblem(kind="site", message=f"the trees have no attribute {name!r}; they have: {known}", where=where)


def _error_text(error: TaskError | PlaceError) -> str:
    """Return the fault and the alternatives, without advice that only a person may follow."""
    return f"{error.what}; {error.advice}" if error.advice and not _TO_A_PERSON.match(error.advice) else error.what
