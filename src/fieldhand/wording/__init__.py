"""Text of plans and missions for people, in any language: steps, conditions, branches, events and limits.

Selectors are worded in their own files (:mod:`fieldhand.places`), numbers, units and names in
:mod:`fieldhand.language.words`.

steps            lines of a plan, one per step
step_places      places of a step: names, order, expected number
resolved_places  places that each node of a plan resolves to, from the walks of a forecast
conditions       conditions and actions as clauses
branches         the outcomes of the conditions on a branch
events           events of a mission, one line each
limits           the crossing of a limit or of a battery level
"""
