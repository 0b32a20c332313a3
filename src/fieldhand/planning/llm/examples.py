"""Requests and good answers that the prompt shows. They are for the built-in robot ``amiga``; a test validates them.

They are chosen for what models get wrong: a place bound and used again, a condition on the reading of this very visit,
"do the same" written out with readings of their own, a budget, a question, a refusal.
"""

from __future__ import annotations

from fieldhand.task.codec_shapes import NAMESPACE

#: The robot that the examples are for.
ROBOT = "amiga"

_NEIGHBOURS = f"""\
<task xmlns="{NAMESPACE}">
  <task-composition>
    <plan>
      <sequence>
        <act label="corner" words="Sample a leaf"><sample_leaf/><at><corners which="sw"/></at></act>
        <for-each words="each of the two trees">
          <select><nearest count="2" adjacent="true"><to><bound label="corner"/></to></nearest></select>
          <body><act words="photograph"><take_picture/></act></body>
        </for-each>
      </sequence>
    </plan>
    <exits nominal="return_to_start" words="come back to the start"/>
  </task-composition>
</task>"""

_EACH = f"""\
<task xmlns="{NAMESPACE}">
  <task-composition>
    <plan>
      <for-each>
        <select><half side="west"><where attribute="variety" test="eq" value="Kerman"/></half></select>
        <body>
          <sequence>
            <act reading="moisture"><read_soil_moisture/></act>
            <if>
              <condition>
                <compare reading="moisture" test="lt"><soil_moisture value="20" unit="percent"/></compare>
              </condition>
              <then><act count="2"><take_picture/></act></then>
              <otherwise><act><sample_leaf/></act></otherwise>
            </if>
          </sequence>
        </body>
      </for-each>
    </plan>
  </task-composition>
  <constraints><budget kind="energy_percent" limit="40"/></constraints>
</task>"""

_AGAIN = f"""\
<task xmlns="{NAMESPACE}">
  <command>
    <assumptions><assumption>"Another tree": the nearest not visited by then.</assumption></assumptions>
  </command>
  <task-composition>
    <plan>
      <sequence>
        <act reading="first"><read_soil_moisture/><at><last/></at></act>
        <if>
          <condition><compare reading="first" test="lt"><soil_moisture value="15" unit="percent"/></compare></condition>
          <then>
            <sequence>
              <act reading="second"><read_soil_moisture/><at><farthest><origin><here/></origin></farthest></at></act>
              <if>
                <condition>
                  <compare reading="second" test="lt"><soil_moisture value="15" unit="percent"/></compare>
                </condition>
                <then><act><take_picture/></act></then>
              </if>
            </sequence>
          </then>
        </if>
        <act><take_picture/><at><take count="1"><other/></take></at></act>
      </sequence>
    </plan>
  </task-composition>
</task>"""

_QUESTION = """\
<question>At which of the four corners?
  <choice>north-west</choice><choice>north-east</choice><choice>south-east</choice><choice>south-west</choice>
</question>"""

_REFUSAL = "<refusal>This robot cannot prune.</refusal>"

#: Requests, each with the answer wanted.
EXAMPLES: tuple[tuple[str, str], ...] = (
    (
        "Sample a leaf at the south-west corner tree, photograph each of the two trees next to it, and come back to "
        "the start.",
        _NEIGHBOURS,
    ),
    (
        "Read the soil moisture of every Kerman tree in the western half. Where it is dry, below 20 percent, take two "
        "pictures of that tree, otherwise sample a leaf. Use no more than 40 % of the battery.",
        _EACH,
    ),
    (
        "Check the moisture at the last tree. If it is below 15 %, do the same at a far away tree, and if that is "
        "below 15 % too, take a picture there. In any case photograph another tree at the end.",
        _AGAIN,
    ),
    ("Take a picture at the corner.", _QUESTION),
    ("Prune the first tree.", _REFUSAL),
)
