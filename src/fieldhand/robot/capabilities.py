"""Convert a robot profile to the capabilities that the task room needs."""

from __future__ import annotations

from collections.abc import Mapping

from fieldhand.robot.model import Parameter, RobotProfile
from fieldhand.task.capabilities import (
    ActionCapability,
    Capabilities,
    ChoiceParameter,
    EventCapability,
    NumberParameter,
    QuantityCapability,
)


def capabilities_of(profile: RobotProfile) -> Capabilities:
    """Return the capabilities of a robot: the input of :func:`fieldhand.task.schema.schema_xsd`."""
    return Capabilities(
        actions={
            a.name: ActionCapability(
                measures=a.measures,
                parameters={p.name: _parameter(p) for p in a.parameters},
                is_implement=a.implement is not None,
            )
            for a in profile.actions
        },
        quantities={q.name: QuantityCapability(unit=q.unit, levels=tuple(q.levels)) for q in profile.quantities},
        events={e.name: EventCapability(unit=e.unit, holds=e.can_hold) for e in profile.events},
    )


def measures_of(profile: RobotProfile) -> Mapping[str, tuple[tuple[str, str], ...]]:
    """Return for each action the quantities that it measures as (name, unit): the ``measures`` of
    ``task.build.make_task``.
    """
    return {
        action.name: tuple((name, profile.quantity[name].unit) for name in action.measures)
        for action in profile.actions
    }


def _parameter(parameter: Parameter) -> NumberParameter | ChoiceParameter:
    if parameter.kind == "choice":
        return ChoiceParameter(choices=parameter.choices)
    return NumberParameter(minimum=parameter.minimum, maximum=parameter.maximum, unit=parameter.unit)
