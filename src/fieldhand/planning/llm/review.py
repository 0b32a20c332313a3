"""From the document that a model wrote to a plan, or to what is wrong with it, in words that the model can act on.

The schema is asked first, then the references inside the plan, then the site (a zone that it does not have, a selection
without trees). Approval checks all of this again for every planner; here it is asked early, because a model can mend
its plan and an operator should not have to.
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

#: Advice to whoever made the request, which a model may not change.
_TO_A_PERSON = re.compile(r"(?:ask|say|name|give|add|count from)\b")

Kind = Literal["answer", "schema", "words", "reference", "site", "coordinate", "request"]


@dataclass(frozen=True, kw_only=True)
class Problem:
    """Why an answer cannot be used.

    Attributes:
        kind: ``answer``: no document could be read; ``schema``: not valid; ``words``: quoted words that are not in
            the request; ``reference``: a name that nothing binds; ``site``: this site does not have it;
            ``coordinate``: a position that nobody gave; ``request``: not what the request says.
        where: Line and element; empty where it is about no place of the document.
    """

    kind: Kind
    message: str
    where: str = ""

    def __str__(self) -> str:
        return f"[{self.kind}] " + (f"{self.where}: " if self.where else "") + self.message


def read_draft(document: str, capabilities: Capabilities, request: str = "") -> TaskDraft | tuple[Problem, ...]:
    """The draft that a document holds, or each problem of its form.

    The ids of the nodes say where in the document they stand (``line 12 <act>``), for the messages that follow;
    ``task.build.make_task`` gives them their own. Ids and ranges that the model wrote do not count: it quotes the words
    of the request, and where they stand is found here.
    """
    data = _with_namespace(document).encode()
    invalid = validate(data, capabilities, draft=True)
    if invalid:
        return tuple(
            Problem(kind="schema", message=p.message, where=f"line {p.line}" + (f" <{p.element}>" if p.element else ""))
            for p in invalid
        )
    root = parse_xml(data)
    unsaid = place_quotes(root, request)
    if unsaid:
        return tuple(Problem(kind="words", message=message, where=where) for where, message in unsaid)
    try:
        return decode_draft(_with_lines(root))
    except TaskError as error:
        return (Problem(kind="schema", message=_said(error), where=error.where),)


def review(draft: TaskDraft, site: Site, capabilities: Capabilities) -> tuple[Problem, ...]:
    """Every problem of a draft with its references and with the site, each once."""
    bare = Task(id="draft", command=Command(request=""), composition=Composition(plan=draft.plan))
    unbound = [Problem(kind="reference", message=message) for message in references(bare, capabilities)]
    return tuple(dict.fromkeys([*unbound, *_places(draft.plan, site)]))


def _with_namespace(document: str) -> str:
    """Small models forget the namespace. There is one only, so adding it changes no meaning."""
    opening = document[: document.find(">") + 1]
    if re.search(r"\sxmlns\s*=", opening):
        return document
    return re.sub(r"^<task\b", f'<task xmlns="{NAMESPACE}"', document, count=1)


def _with_lines(root: _Element) -> bytes:
    """The document with the place of each node as its id, each once."""
    from lxml import etree

    nodes = {f"{{{NAMESPACE}}}{element_name(cls)}" for cls in get_args(Node)}
    used: dict[str, int] = {}
    for element in root.iter(*nodes):
        name = f"line {line_of(element)} <{etree.QName(element).localname}>"
        used[name] = used.get(name, 0) + 1
        element.set("id", name if used[name] == 1 else f"{name} no. {used[name]}")
    encoded: bytes = etree.tostring(root, encoding="UTF-8")
    return encoded


def _places(root: Node, site: Site) -> Iterator[Problem]:
    """Problems with what selectors and conditions expect of the site."""
    known = {phrase(name) for name in site.attributes}
    for node in plan.walk(root):
        selector = node.selector
        if selector is not None:
            yield from _unresolved(selector, site, node.id)
            if not node.visits_each:
                yield from _more_than_one(selector, site, node.id)
        if node.rewarded_by and phrase(node.rewarded_by) not in known:
            yield _no_attribute(node.rewarded_by, site, node.id)
        condition = node.tested
        for part in conditions.walk(condition) if condition is not None else ():
            if isinstance(part, TreeHas) and phrase(part.attribute) not in known:
                yield _no_attribute(part.attribute, site, node.id)


def _unresolved(selector: Selector, site: Site, where: str) -> Iterator[Problem]:
    """Problems of the largest parts that can be resolved before the mission begins."""
    for part in foreseeable(selector):
        try:
            _resolve(part, site)
        except PlaceError as error:
            yield Problem(kind="site", message=_said(error), where=where)


def _more_than_one(selector: Selector, site: Site, where: str) -> Iterator[Problem]:
    """An act or a drive goes to one place; several need a for-each, or a choice of one."""
    if selector.single or isinstance(selector, Bound) or _one_of_a_row(selector):
        return
    if not selector.relative:
        try:
            if len(_resolve(selector, site)) == 1:
                return
        except PlaceError:
            return  # said already
    name = element_name(type(selector))
    message = f'<{name}> gives several places where one is needed: use a <for-each>, or <take count="1">'
    yield Problem(kind="site", message=message, where=where)


def _one_of_a_row(selector: Selector) -> bool:
    """One tree by its number, of the row of one place."""
    of = selector.of if isinstance(selector, InRow) and selector.first == selector.last else None
    return of is not None and of.row_of is not None and of.row_of.single


def _resolve(selector: Selector, site: Site) -> tuple[Place, ...]:
    from fieldhand.places.resolution import resolve

    return resolve(selector, site, Context(here=site.start))


def _no_attribute(name: str, site: Site, where: str) -> Problem:
    known = ", ".join(list(site.attributes)[:20]) or "none"
    return Problem(kind="site", message=f"the trees have no attribute {name!r}; they have: {known}", where=where)


def _said(error: TaskError | PlaceError) -> str:
    """Say the fault and what there is; without advice to ask for something else, which only a person may follow."""
    return f"{error.what}; {error.advice}" if error.advice and not _TO_A_PERSON.match(error.advice) else error.what
