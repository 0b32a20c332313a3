"""The language description: complete, in the words of the docstrings, and in the forms that the schema knows."""

from __future__ import annotations

import inspect
import re
from itertools import pairwise
from typing import get_args

import pytest
from lxml import etree

from fieldhand.errors import ModelError
from fieldhand.places.selectors import SELECTORS
from fieldhand.planning.llm import language
from fieldhand.planning.llm.language import DERIVED, describe_language
from fieldhand.planning.llm.prompt import instructions, watch_rules
from fieldhand.planning.llm.review import read_draft
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.task import plan
from fieldhand.task.capabilities import Capabilities
from fieldhand.task.codec import TaskDraft
from fieldhand.task.codec_shapes import all_shapes, element_name, shape_of
from fieldhand.task.conditions import Condition
from fieldhand.task.plan import Node
from fieldhand.task.schema import schema_xsd
from fieldhand.task.timing import Timing
from fieldhand.testing.generated.tasks import ROVER

HUSKY, AMIGA = capabilities_of(load_robot("husky")), capabilities_of(load_robot("amiga"))
TRACTOR = capabilities_of(load_robot("tractor"))
#: Parts of a draft that the program writes.
UNSHOWN = {"resources", "resource", "state", "variable", "goals", "goal", "warnings", "warning", "read-as", "request"}
UNWRITTEN = DERIVED | {"expected", "node", "conditional", "value-as", "sha256", "action"}
#: Records of earlier missions, which the program writes.
RECORDS = [shape for cls, shape in all_shapes().items() if cls.__module__ == "fieldhand.site.earlier_missions"]
UNSHOWN |= {shape.element for shape in RECORDS}
UNWRITTEN |= {attribute.name for shape in RECORDS for attribute in shape.attributes}
EVERY = [*get_args(Node), *get_args(Condition), *SELECTORS]


@pytest.mark.parametrize("cls", EVERY, ids=lambda cls: cls.__name__)
def test_every_class_is_described_with_its_attributes_and_its_own_words(cls: type) -> None:
    form, meaning = paragraphs()[element_name(cls)]
    for attribute in shape_of(cls).attributes:
        assert (f'{attribute.name}="' in form) == (attribute.name not in DERIVED)
    first_words = re.split(r"``|\n", inspect.cleandoc(cls.__doc__ or ""))[0].split()
    assert " ".join(first_words) in meaning


def test_every_element_that_is_named_stands_in_the_schema() -> None:
    schema = schema_xsd(Capabilities(actions=ROVER.actions, quantities=ROVER.quantities), draft=True).decode()
    named = set(re.findall(r"</?([a-z][a-z-]*)", describe_language()))
    assert named
    for name in named:
        assert f'name="{name}"' in schema, name


def test_a_default_that_changes_the_meaning_is_shown() -> None:
    assert '[count="2"]' in paragraphs()["adjacent"][0]
    assert '[count="1"]' in paragraphs()["nearest"][0]


def test_nothing_of_python_is_left() -> None:
    assert not re.search(r"``|:class:|:attr:|=\.\.\.|ForEach|GoTo|at_most", describe_language())


def test_without_docstrings_there_is_a_clear_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "__doc__", None)
    language.describe_language.cache_clear()
    with pytest.raises(ModelError, match="-OO"):
        describe_language()


def paragraphs() -> dict[str, tuple[str, str]]:
    """Form and meaning of each element."""
    lines = describe_language().splitlines()
    found = {}
    for form, meaning in pairwise(lines):
        if form.startswith("<") and meaning.startswith("  "):
            found[re.split(r"[\s>/]", form[1:])[0]] = (form, meaning.strip())
    return found


def test_what_stands_for_a_selector_that_is_left_out_is_shown() -> None:
    forms = {name: form for name, (form, _) in paragraphs().items()}
    for name in ("spaced", "successive"):
        assert "[<near>S (<here/>)</near>]" in forms[name]
    for name in ("along-row", "across"):
        assert "[S = origin (<here/>)]" in forms[name]
    assert forms["half"].endswith(">[S]")


def filled(form: str, *, whole: bool) -> str:
    """A form of the prompt as an element: one value for each placeholder, optional parts in it or left out."""
    form = re.sub(r"\[((?:[^\[\]]|\[[^\]]*\])*)\]", r"\1" if whole else "", form)
    form = re.sub(r"\bOF\b", "<of>S</of>", form).replace(" = origin", "").replace(" (<here/>)", "")
    form = re.sub(r"(?<=>)<([a-z-]+)/>\|\S*", lambda m: filled(paragraphs()[m[1]][0], whole=whole), form)
    form = re.sub(r"<(budget|faulted)/>", lambda m: filled(paragraphs()[m[1]][0], whole=whole), form)
    for short, one in (("SIDE", "north"), ("TEST", "lt"), ("some of: ", ""), ("int", "1"), ("number", "0.5")):
        form = form.replace(f'"{short}', f'"{one}')
    form = re.sub(r'"([^"|]*)\|[^"]*"', r'"\1"', form)
    name, heads = re.split(r"[\s>/]", form[1:])[0], {"ACTION": "drive", "QUANTITY": "height"}
    for letter, inner in (("S", "<trees/>"), ("N", "<stop/>"), ("C", '<tree-has attribute="a" test="eq" value="1"/>')):
        form = re.sub(rf"(?<=>)\s*{letter}(\.\.\.)?|(?<=> ){letter}(\.\.\.)?", inner, form)
    form = form.replace("...", "")
    for placeholder, head in heads.items():
        form = form.replace(placeholder, head)
    return form if form.rstrip().endswith("/>") and form.count("<") == 1 else f"{form}</{name}>"


@pytest.mark.parametrize("whole", [True, False], ids=["whole", "least"])
@pytest.mark.parametrize("cls", EVERY, ids=lambda cls: cls.__name__)
def test_every_form_that_is_shown_is_valid_with_all_that_may_be_left_out_and_without(cls: type, whole: bool) -> None:
    robot = TRACTOR if cls is plan.WorkAlong else HUSKY
    action, quantity = next(iter(robot.actions)), "co2"
    element = filled(paragraphs()[element_name(cls)][0], whole=whole).replace("<drive/>", f"<{action}/>")
    element = (
        element.replace("<height ", f"<{quantity} ")
        .replace("<height/>", f"<{quantity}/>")
        .replace('unit="name"', 'unit="ppm"')
        .replace('level="name"', 'level="low"')
    )
    if cls in SELECTORS:
        element = f"<go-to>{element}</go-to>"
    elif cls in get_args(Condition):
        element = f"<if><condition>{element}</condition><then><stop/></then></if>"
    document = f"<task><task-composition><plan>{element}</plan></task-composition></task>"
    draft = read_draft(document, robot)
    assert isinstance(draft, TaskDraft), (element, draft)


@pytest.mark.parametrize("cls", get_args(Timing), ids=lambda cls: cls.__name__)
def test_the_form_of_a_time_is_valid_with_a_time_in_place_of_its_attributes(cls: type) -> None:
    form = re.sub(r"[][]", "", paragraphs()[element_name(cls)][0])
    for shown, written in (("DAY-TIME", 'sun="sunrise"'), ('="int"', '="1"'), ('day="name"', 'day="+3"')):
        form = form.replace(shown, written)
    form = re.sub(r'"(?:some of: )?([a-z]+)[ |][^"]*"', r'"\1"', form).replace(
        "<day-time/>...", '<day-time clock="06:00"/>'
    )
    timing = f"<timing>{form}</{element_name(cls)}></timing>"
    document = f"<task><task-composition><plan><stop/></plan></task-composition>{timing}</task>"
    draft = read_draft(document, HUSKY)
    assert isinstance(draft, TaskDraft), (form, draft)
    assert isinstance(draft.timing, cls)


def test_every_element_and_attribute_of_the_schema_is_in_the_prompt() -> None:
    schema = etree.fromstring(schema_xsd(AMIGA, draft=True))
    xs = "{http://www.w3.org/2001/XMLSchema}"
    own = {*AMIGA.actions, *AMIGA.quantities}
    heads = [e for e in schema.iter(f"{xs}element") if e.get("name") in own]
    parameters = {a.get("name") for head in heads for a in head.iter(f"{xs}attribute")}
    text = f"{instructions()}\n{watch_rules(load_robot('amiga'))}"
    for element in schema.iter(f"{xs}element"):
        name = element.get("name")
        assert name is None or name in own | UNSHOWN or re.search(rf"<{name}[\s>/]", text), name
    for attribute in schema.iter(f"{xs}attribute"):
        name = attribute.get("name")
        assert name is None or name in UNWRITTEN | parameters or f'{name}="' in text, name


def test_every_element_and_attribute_that_the_rules_and_examples_write_is_of_the_language() -> None:
    shapes = {shape.element: {a.name for a in shape.attributes} for shape in all_shapes().values()}
    text = instructions()
    for name, inside in re.findall(r"<([a-z][a-z-]*)((?: [a-z-]+=\"[^\"<>]*\")*) ?/?>", text):
        if name in shapes:
            written = set(re.findall(r"([a-z-]+)=", inside)) - {"words", "xmlns"}
            assert written <= shapes[name], (name, written - shapes[name])
    alone = set(re.findall(r"[ (]([a-z]+(?:-[a-z]+)*)=\"", text.partition("# The plan language")[0]))
    assert alone - {"words", "xmlns"} <= set().union(*shapes.values())
