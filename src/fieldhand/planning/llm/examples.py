"""Example requests and answers for the prompt, for the built-in robot ``amiga``; a test validates them.

They cover frequent errors of models: a condition on a reading of the current visit, a place bound and used again,
"do the same" written out, steps outside a branch, a budget, quoting every word, a question, a refusal.
"""

from __future__ import annotations

from fieldhand.task.codec_shapes import NAMESPACE

#: Robot of the examples.
ROBOT = "amiga"

_EACH = f"""\
<task xmlns="{NAMESPACE}">
  <command words="Please"/>
  <task-composition>
    <plan>
      <for-each words="every Kerman tree in the western half">
        <select><half side="west"><where attribute="variety" test="eq" value="Kerman"/></half></select>
        <body>
          <sequence>
            <act reading="moisture" words="read the soil moisture"><read_soil_moisture/></act>
            <if words="Where it is below 20 percent">
              <condition>
                <compare reading="moisture" test="lt"><soil_moisture value="20" unit="percent"/></compare>
              </condition>
              <then><act count="2" words="take two pictures of that tree"><take_picture/></act></then>
              <otherwise><act words="otherwise|sample a leaf"><sample_leaf/></act></otherwise>
            </if>
          </sequence>
        </body>
      </for-each>
    </plan>
  </task-composition>
  <constraints><budget kind="energy_percent" limit="40" words="Use at most 40 % of the battery"/></constraints>
</task>"""

_AGAIN = f"""\
<task xmlns="{NAMESPACE}">
  <command>
    <assumptions><assumption>"Another tree": the nearest not visited by then.</assumption></assumptions>
  </command>
  <task-composition>
    <plan>
      <sequence>
        <act label="corner" reading="first" words="Check the moisture at the south-west corner tree">
          <read_soil_moisture/>
          <at><corners which="sw"/></at>
        </act>
        <if words="If it is below 15 %">
          <condition><compare reading="first" test="lt"><soil_moisture value="15" unit="percent"/></compare></condition>
          <then>
            <for-each words="at the two trees next to it">
              <select><nearest count="2" adjacent="true"><to><bound label="corner"/></to></nearest></select>
              <body><act words="do the same"><read_soil_moisture/></act></body>
            </for-each>
          </then>
        </if>
        <act words="Then photograph another tree"><take_picture/><at><take count="1"><other/></take></at></act>
      </sequence>
    </plan>
    <exits nominal="return_to_start" words="come back to the start"/>
  </task-composition>
</task>"""

_QUESTION = """\
<question>At which corner?
  <choice>north-west</choice><choice>north-east</choice><choice>south-east</choice><choice>south-west</choice>
</question>"""

_REFUSAL = "<refusal>It cannot prune: it has no action for that.</refusal>"

#: Pairs of request and expected answer.
EXAMPLES: tuple[tuple[str, str], ...] = (
    (
        "Please read the soil moisture of every Kerman tree in the western half. Where it is below 20 "
        "percent, take two pictures of that tree, otherwise sample a leaf. Use at most 40 % of the battery.",
        _EACH,
    ),
    (
        "Check the moisture at the south-west corner tree. If it is below 15 %, do the same at the two trees next to "
        "it. Then photograph another tree and come back to the start.",
        _AGAIN,
    ),
    ("Take a picture at the corner.", _QUESTION),
    ("Prune the first tree tomorrow.", _REFUSAL),
)
