"""A schema lets in what its robot can do, refuses what it cannot, and says so in words."""

from __future__ import annotations

import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lxml import etree

from fieldhand.errors import TaskError
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot, robot_names
from fieldhand.task.capabilities import ActionCapability, Capabilities, NumberParameter
from fieldhand.task.codec import decode, encode
from fieldhand.task.codec_shapes import all_shapes
from fieldhand.task.plan import walk
from fieldhand.task.references import references
from fieldhand.task.schema import require_valid, schema_xsd, validate
from fieldhand.task.schema_build import type_name
from fieldhand.testing.generated.tasks import ROVER, Parts

DOCUMENT = b"""<task xmlns="urn:fieldhand:task:1" id="t">
  <command>
    <request>go</request>
    <goals><goal id="g1" node="n3" action="probe_soil" expected="1"/></goals>
    <state><variable name="r1" node="n3"><soil_moisture unit="percent"/></variable></state>
  </command>
  <task-composition>
    <plan>
      <sequence id="n1">
        <for-each id="n2" at-most="6">
          <select><corners which="nw ne"><half side="north"/></corners></select>
          <body>
            <act id="n3" reading="r1" said="0-2"><probe_soil depth_cm="20" gain="2"/></act>
          </body>
        </for-each>
        <if id="n4">
          <condition>
            <all-of>
              <compare reading="r1" test="lt"><soil_moisture value="20" unit="percent"/></compare>
              <level reading="r1"><soil_moisture level="very high"/></level>
              <between reading="r1"><soil_ph low="5" high="7.5" unit="pH"/></between>
            </all-of>
          </condition>
          <then><act id="n5" count="2"><take_picture view="trunk"/><at><here/></at></act></then>
        </if>
      </sequence>
    </plan>
    <exits><faulted fault="aborted" then="stay"/></exits>
  </task-composition>
  <constraints reserve-percent="20"><budget kind="distance_m" limit="100" failure-probability="0.05"/></constraints>
  <resources><resource kind="robot" name="rover" sha256="00"/></resources>
</task>
"""


def said(document: bytes, *, draft: bool = False) -> str:
    """The problems of a document, one a line."""
    problems = validate(document, ROVER, draft=draft)
    text = "\n".join(str(p) for p in problems)
    assert "{" not in text
    assert "urn:" not in text or "outermost" in text
    assert [p.line for p in problems] == sorted(p.line for p in problems)
    return text


def test_the_good_document_is_valid():
    assert said(DOCUMENT) == ""


@pytest.mark.parametrize("draft", [False, True])
def test_the_schema_is_itself_valid_and_the_same_every_time(draft):
    for capabilities in (ROVER, *(capabilities_of(load_robot(name)) for name in robot_names())):
        xsd = schema_xsd(capabilities, draft=draft)
        etree.XMLSchema(etree.fromstring(xsd))
        assert xsd == schema_xsd(capabilities, draft=draft)


@pytest.mark.parametrize(
    ("right", "wrong", "expected"),
    [
        ("<probe_soil ", "<probe_sol ", "line 13, <probe_sol>: is not known inside <act>; did you mean 'probe_soil'?"),
        ('<take_picture view="trunk"/>', "<water_tree/>", "known: take_picture, probe_soil, read_co2, at"),
        ("<probe_soil ", "<read_co2 ", "<read_co2>: has no attribute 'depth_cm'; it takes none"),
        ('depth_cm="20"', 'depht_cm="20"', "has no attribute 'depht_cm'; did you mean 'depth_cm'?"),
        ('depth_cm="20"', 'depth_cm="61"', 'depth_cm="61" is out of bounds: it must be at most 60'),
        ('depth_cm="20"', 'depth_cm="4.9"', 'depth_cm="4.9" is out of bounds: it must be at least 5'),
        ('depth_cm="20"', 'depth_cm="deep"', 'depth_cm="deep" is not a number'),
        ('gain="2"', 'gain="INF"', 'gain="INF" is not a number'),
        ('view="trunk"', 'view="roots"', 'view="roots" must be one of canopy, trunk'),
        ("<soil_ph low", "<ndvi low", "line 21, <ndvi>: is not known inside <between>"),
        ('value="20" unit="percent"', 'value="20" unit="ppm"', 'unit="ppm" must be percent'),
        ('value="20" unit="percent"', 'value="20"', "the attribute 'unit' is missing"),
        ('value="20" unit="percent"', 'value="dry" unit="percent"', 'value="dry" is not a number'),
        ('level="very high"', 'level="high"', 'level="high" must be one of low, very high'),
        ('<soil_moisture level="very high"/>', '<soil_ph level="low"/>', "<soil_ph>: is not known inside <level>"),
        ('test="lt"', 'test="&lt;"', 'test="<" must be one of lt, le, gt, ge, eq, ne'),
        (
            '<soil_moisture unit="percent"/>',
            '<soil_moisture unit="ppm"/>',
            'line 5, <soil_moisture>: unit="ppm" must be',
        ),
        ('action="probe_soil"', 'action="dig"', 'action="dig" must be one of take_picture, probe_soil, read_co2'),
        ('node="n3" action', 'node="n9" action', "<goal>: names the node 'n9', which the plan does not have"),
        ('id="n5"', 'id="n1"', "the id 'n1' is used twice"),
        (' id="n5"', "", "the attribute 'id' is missing"),
        ('which="nw ne"', 'which="nw nn"', 'which="nn" must be one of nw, ne, se, sw'),
        ('side="north"', 'side="up"', 'side="up" must be one of north, east, south, west'),
        ("<half ", "<hafl ", "<hafl>: is not known inside <corners>; did you mean 'half'?"),
        ('<half side="north"/>', "<here/><trees/>", "<trees>: is one too many inside <corners>"),
        ("<here/>", "", "<at>: lacks an element inside; one of: trees, tree-is,"),
        ("<condition>", "<case/><condition>", "<case>: is not known inside <if>; known: condition, then, otherwise"),
        ("<select>", "<select>every tree", "<select>: contains text between its elements"),
        ('count="2"', 'count="0"', 'count="0" is out of bounds: it must be at least 1'),
        ('count="2"', 'count="1001"', 'count="1001" is out of bounds: it must be at most 1000'),
        ('count="2"', 'count="two"', 'count="two" is not a whole number'),
        ('said="0-2"', 'said="0"', 'said="0" is not a list of character ranges'),
        ('limit="100"', 'limit="0"', 'limit="0" is out of bounds: it must be above 0'),
        ('failure-probability="0.05"', 'failure-probability="1"', "it must be below 1"),
        ('kind="distance_m"', 'kind="distance"', "did you mean 'distance_m'?"),
        ('reserve-percent="20"', 'reserve="20"', "<constraints>: has no attribute 'reserve'"),
        ('name="rover"', 'name=""', "the attribute 'name' is empty"),
        ("<request>go</request>", "", "<command>: lacks <request>"),
        ('xmlns="urn:fieldhand:task:1"', "", "is not a Task document: the outermost element is <task xmlns="),
        ("</task>", "", "is not well-formed XML"),
        ("<task ", "<!DOCTYPE task><task ", "line 1: holds <!DOCTYPE"),
    ],
)
def test_what_the_robot_lacks_is_not_valid_and_is_named(right, wrong, expected):
    assert right.encode() in DOCUMENT
    assert expected in said(DOCUMENT.replace(right.encode(), wrong.encode(), 1))


@pytest.mark.parametrize(
    ("speed", "expected"),
    [("1e-310", "at least 0.01"), ("0", "at least 0.01"), ("20.1", "at most 20"), ("0.01", ""), ("20", "")],
)
def test_a_speed_is_one_that_a_robot_drives_at(speed, expected):
    found = said(DOCUMENT.replace(b'reserve-percent="20"', f'speed-m-s="{speed}"'.encode()))
    assert expected in found
    assert bool(found) == bool(expected)


@pytest.mark.parametrize(
    ("reward", "expected"),
    [("0", ""), ("2.5", ""), ("-1", "at least 0"), ("INF", "is not a number"), ("much", "is not a number")],
)
def test_an_optional_step_is_worth_a_finite_number_from_0_on(reward, expected):
    act = b'<act id="n5" count="2"><take_picture view="trunk"/><at><here/></at></act>'
    found = said(DOCUMENT.replace(act, f'<optional id="n6" reward="{reward}">'.encode() + act + b"</optional>"))
    assert expected in found
    assert bool(found) == bool(expected)


def test_an_optional_step_holds_one_node():
    act = b'<act id="n5" count="2"><take_picture view="trunk"/><at><here/></at></act>'
    assert "<optional>: lacks an element inside" in said(DOCUMENT.replace(act, b'<optional id="n6"/>'))
    two = b'<optional id="n6">' + act + act.replace(b"n5", b"n7") + b"</optional>"
    assert "one too many inside <optional>" in said(DOCUMENT.replace(act, two))


@pytest.mark.parametrize(("times", "valid"), [("1", True), ("1000", True), ("1001", False), ("999999999999", False)])
def test_rounds_have_a_bound(times, valid):
    act = b'<act id="n5" count="2"><take_picture view="trunk"/><at><here/></at></act>'
    repeat = f'<repeat id="n6" times="{times}"><body>'.encode() + act + b"</body></repeat>"
    assert (said(DOCUMENT.replace(act, repeat)) == "") is valid


def test_one_mistake_is_one_problem():
    assert len(validate(DOCUMENT.replace(b'"lt"', b'"less"'), ROVER)) == 1
    assert len(validate(DOCUMENT.replace(b"<condition>", b"<case/><condition>"), ROVER)) == 1


def test_require_valid_raises_every_problem_as_one_line():
    require_valid(DOCUMENT, ROVER)
    bad = DOCUMENT.replace(b'test="lt"', b'test="less"').replace(b"<probe_soil ", b"<dig ")
    with pytest.raises(TaskError) as error:
        require_valid(bad, ROVER, source="m.xml")
    assert str(error.value).startswith("m.xml: is not valid for this robot: line 13, <dig>: ")
    assert "line 19, <compare>: " in str(error.value)
    assert "\n" not in str(error.value)
    worse = re.sub(rb"<(budget|resource|faulted|level|here|act|half|goal|stop) ", rb'<\1 colour="red" ', DOCUMENT)
    with pytest.raises(TaskError, match=" and 5 more; correct the document"):
        require_valid(worse, ROVER)


def test_a_draft_needs_a_plan_and_nothing_else():
    draft = b'<task xmlns="urn:fieldhand:task:1"><task-composition><plan><stop/></plan></task-composition></task>'
    assert said(draft, draft=True) == ""
    assert "<task>: the attribute 'id' is missing" in said(draft)
    assert "<task-composition>: lacks <plan>" in said(draft.replace(b"<plan><stop/></plan>", b""), draft=True)


def test_a_draft_is_held_to_the_same_robot():
    draft = re.sub(rb"<(goals|state|resources)>.*</\1>", b"", re.sub(rb' id="[^"]*"', b"", DOCUMENT))
    assert said(draft, draft=True) == ""
    assert "<dig>: is not known inside <act>" in said(draft.replace(b"probe_soil", b"dig"), draft=True)
    assert 'unit="ppm" must be percent' in said(draft.replace(b'20" unit="percent"', b'20" unit="ppm"'), draft=True)


def test_two_nodes_of_a_draft_may_not_share_an_id():
    assert "the id 'n1' is used twice" in said(DOCUMENT.replace(b'"n5"', b'"n1"'), draft=True)


def test_a_robot_that_measures_nothing_has_no_conditions_on_readings():
    camera = Capabilities(actions={"take_picture": ActionCapability()}, quantities={})
    xsd = schema_xsd(camera)
    etree.XMLSchema(etree.fromstring(xsd))
    assert b'name="compare"' not in xsd
    assert b'name="tree-has"' in xsd
    assert "<compare>: is not known inside <all-of>" in "\n".join(str(p) for p in validate(DOCUMENT, camera))


def test_every_class_of_the_room_has_a_type_with_its_docstring():
    schema = etree.fromstring(schema_xsd(ROVER))
    types = {t.get("name"): t for t in schema.findall("{*}complexType")}
    for shape in all_shapes().values():
        documentation = types[type_name(shape.cls)].findtext("{*}annotation/{*}documentation")
        assert documentation.split()[0] == shape.cls.__doc__.replace("``", "'").split()[0]


def test_the_document_in_the_docs_is_valid_sound_and_what_encode_writes():
    page = (Path(__file__).resolve().parents[2] / "docs" / "formats.md").read_text()
    document = re.search(r"```xml\n(.*?)```", page, re.DOTALL)[1].encode()
    husky = capabilities_of(load_robot("husky"))
    assert validate(document, husky) == ()
    task = decode(document)
    assert references(task, husky) == ()
    written = encode(task).partition(b"?>\n")[2]
    assert written == document.replace(b'<exits nominal="return_to_end">', b"<exits>")
    for node in walk(task.composition.plan):
        assert all(task.command.request[start:end].strip() for start, end in node.said)


PARTS = Parts(ROVER, depth=2)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(PARTS.tasks(), st.data())
def test_a_document_is_not_valid_once_one_of_its_actions_or_quantities_is_renamed(task, data):
    root = etree.fromstring(encode(task))
    able = [*ROVER.actions, *ROVER.quantities]
    heads = [e for e in root.iter() if etree.QName(e).localname in able]
    if heads:
        head = data.draw(st.sampled_from(heads))
        head.tag += data.draw(st.sampled_from(("x", "_2", "-")))
        problems = validate(etree.tostring(root), ROVER)
        assert any(
            etree.QName(head).localname in p.message or p.element == etree.QName(head).localname for p in problems
        )


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(PARTS.tasks(), st.data())
def test_a_document_is_not_valid_once_it_has_an_attribute_that_no_class_has(task, data):
    root = etree.fromstring(encode(task))
    element = data.draw(st.sampled_from(list(root.iter())))
    element.set("colour", "1")
    assert validate(etree.tostring(root), ROVER)


def test_robots_of_one_name_that_differ_in_a_bound_have_a_schema_each():
    def rover(most: float) -> Capabilities:
        probe = ROVER.actions["probe_soil"]
        parameters = dict(probe.parameters) | {"depth_cm": NumberParameter(minimum=1, maximum=most, unit="cm")}
        return replace(ROVER, actions=dict(ROVER.actions) | {"probe_soil": replace(probe, parameters=parameters)})

    for _ in range(2):  # the second time from what was kept
        assert not validate(DOCUMENT, rover(20.0))
        assert ["20" in str(problem) for problem in validate(DOCUMENT, rover(19.0))] == [True]


def test_threads_that_ask_one_schema_hear_of_their_own_document_only():
    wrong = [DOCUMENT.replace(b'"n5"', f'"n{k}" bad{k}="1"'.encode()) for k in range(10, 18)]
    alone = [validate(document, ROVER) for document in wrong]
    assert len({str(problems) for problems in alone}) == len(wrong)
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(lambda document: validate(document, ROVER), wrong * 2)) == alone * 2
