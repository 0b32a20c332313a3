"""Whatever is no Task document is refused in one line that says where and what."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import TaskError
from fieldhand.task.codec import decode, decode_draft
from fieldhand.task.codec_xml import MAX_BYTES

HEAD = '<task xmlns="urn:fieldhand:task:1" id="t">\n<command><request>go</request></command>\n<task-composition><plan>'
TAIL = "</plan></task-composition></task>"


def document(plan: str) -> bytes:
    """A document whose plan begins on line 4."""
    return f"{HEAD}\n{plan}\n{TAIL}".encode()


def refused(data: bytes) -> str:
    with pytest.raises(TaskError) as error:
        decode(data, source="m.xml")
    message = str(error.value)
    assert message.startswith("m.xml")
    assert "\n" not in message
    return message


def test_the_good_document_is_read():
    assert decode(document('<stop id="n1"/>')).composition.plan.id == "n1"


@pytest.mark.parametrize(
    ("plan", "expected"),
    [
        ("", "line 3, <plan>: a node inside is missing"),
        ('<stopp id="n1"/>', "line 4, <stopp>: is unknown here; did you mean 'stop'?"),
        ('<stop id="n1" exits="x"/>', "line 4, <stop>: has no attribute 'exits'; did you mean 'exit'?"),
        ("<stop/>", "line 4, <stop>: the attribute id is missing"),
        ('<stop id="n1" exit="now"/>', "exit: 'now' is not one of nominal, faulted"),
        ('<stop id="n1">now</stop>', "contains the text 'now' between its elements"),
        ('<stop id="n1"/><stop id="n2"/>', "<stop>: is one too many: <plan> can contain only one"),
        ('<stop id="n1" said="3"/>', "said: '3' is not a list of character ranges"),
        ('<act id="n1"/>', "has 0 elements that name the action"),
        ('<act id="n1"><a/><b/></act>', "has 2 elements that name the action"),
        ('<act id="n1"><a><b/></a></act>', "<b>: is not allowed inside <a>"),
        ('<act id="n1"><a x="true"/></act>', "the parameter x is neither a number nor a word"),
        ('<act id="n1" count="2.5"><a/></act>', "count: '2.5' is not a whole number"),
        ('<act id="n1"><a/><at><here/></at><at><here/></at></act>', "<at>: is given twice here"),
        ('<repeat id="n1" times="2"><boddy/></repeat>', "<boddy>: is unknown here; did you mean 'body'?"),
        ('<repeat id="n1" times="2"/>', "<body> is missing"),
        ('<go-to id="n1"><in-zone zone="z" outside="maybe"/></go-to>', "'maybe' is neither true nor false"),
        ('<go-to id="n1"><within distance-m="1e999"><to><here/></to></within></go-to>', "'1e999' is too large"),
        ('<go-to id="n1"><within distance-m="far"><to><here/></to></within></go-to>', "'far' is not a number"),
        ('<go-to id="n1"><where attribute="a" test="eq" value="1" value-as="x"/></go-to>', "the only possible mark"),
        ('<x:stop xmlns:x="urn:other" id="n1"/>', "is not in the namespace of Task documents"),
    ],
)
def test_what_does_not_belong_is_named_with_its_line(plan, expected):
    assert expected in refused(document(plan))


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"", "the document is empty"),
        (b" \n ", "the document is empty"),
        (b"take a picture", "line 1: is not well-formed XML"),
        (b"<task", "is not well-formed XML"),
        (document("<stop id='n1'>"), "is not well-formed XML: Opening and ending tag mismatch"),
        (document("<stop id='n1' id='n2'/>"), "is not well-formed XML: Attribute id redefined"),
        (document("<stop id='&#0;'/>"), "is not well-formed XML"),
        (document("<stop id='&me;'/>"), "is not well-formed XML"),
        (b"<task><plan/></task>", "line 1, <task>: the namespace is missing; write <task xmlns="),
        (b'<plan xmlns="urn:fieldhand:task:1"/>', "is not a Task document"),
        (b"<kml/>", "is not a Task document"),
        ("<tâche/>".encode("latin-1"), "line 1: is not UTF-8 text"),
        (f"<?xml version='1.0' encoding='UTF-16'?>{HEAD}".encode("utf-16"), "is not UTF-8 text"),
        (b"<task>" + b" " * MAX_BYTES, "more than 4000000"),
        (
            b'<task xmlns="urn:fieldhand:task:1" id="t">' + b"<a>" * 150 + b"</a>" * 150 + b"</task>",
            "is unknown here",
        ),
        (b"<a>" * 250 + b"</a>" * 250, "more than 200 elements are nested; nest less deeply"),
        (b"<a>" * 100_000 + b"</a>" * 100_000, "is not well-formed XML: Excessive depth"),
    ],
)
def test_what_is_no_task_document_is_refused(data, expected):
    assert expected in refused(data)


def test_an_external_entity_is_refused_and_its_file_is_not_read(tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text("the secret")
    data = f'<!DOCTYPE task [<!ENTITY x SYSTEM "{secret.as_uri()}">]>\n'.encode() + document("&x;")
    message = refused(data)
    assert "line 1: holds <!DOCTYPE" in message
    assert "secret" not in message.partition("DOCTYPE")[2]


@pytest.mark.parametrize("place", ["text", "attribute"])
def test_an_entity_bomb_is_refused_before_it_is_read(place):
    entities = "".join(f'<!ENTITY e{i + 1} "{f"&e{i};" * 10}">' for i in range(9))
    bomb = f'<!DOCTYPE task [<!ENTITY e0 "ha">{entities}]>'
    plan = "<stop id='n1'>&e9;</stop>" if place == "text" else "<stop id='&e9;'/>"
    assert "holds <!DOCTYPE" in refused(bomb.encode() + document(plan))


def test_a_document_type_cannot_hide_behind_another_encoding():
    hidden = b'<?xml version="1.0" encoding="UTF-7"?>+ADwAIQ-DOCTYPE task []+AD4-' + document('<stop id="n1"/>')
    assert "is not well-formed XML" in refused(hidden)


@settings(max_examples=150, deadline=None)
@given(st.binary(max_size=60), st.integers(0, 250), st.integers(0, 60))
def test_damage_ends_in_a_task_or_a_task_error_and_in_nothing_else(noise, start, length):
    whole = document('<act id="n1" said="0-2"><read_co2/><at><corners which="nw"/></at></act>')
    damaged = whole[:start] + noise + whole[start + length :]
    for read in (decode, decode_draft):
        try:
            read(damaged)
        except TaskError as error:
            assert "\n" not in str(error)  # noqa: PT017
