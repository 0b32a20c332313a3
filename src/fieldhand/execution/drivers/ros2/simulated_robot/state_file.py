"""File from which a simulated robot continues after it was ended or killed."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from fieldhand.errors import InputError, OutputError
from fieldhand.execution.drivers.simulation.state import SimulationState
from fieldhand.files import FileFault, read_file, write_whole

#: Size limit in bytes; the state of a robot that used every sensor at every tree of a large site is smaller.
_MOST_BYTES = 50_000_000

Finite = Annotated[float, Field(allow_inf_nan=False)]
Count = Annotated[int, Field(ge=0)]


@dataclass(frozen=True, kw_only=True)
class Identity:
    """Identity of the robot that a state belongs to: SHA-256 of its site's content, of its profile, and of its world
    file.

    Attributes:
        world: Empty for a world without faults.
    """

    site: str
    robot: str
    world: str = ""


class _Document(BaseModel):
    """Document model of the file."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    format: Literal[1]
    site: str
    robot: str
    world: str
    seconds: Annotated[Finite, Field(ge=0)]
    x: Finite
    y: Finite
    charge_percent: Annotated[Finite, Field(ge=0, le=100)]
    generator: dict[str, Any]
    values_seed: Count
    captures: tuple[tuple[str, str, Count], ...]
    struck: tuple[tuple[Count, Count], ...]
    lost: tuple[tuple[Finite | None, str], ...]
    met: tuple[tuple[Count, Finite], ...] = ()
    docked: bool = False
    heading_deg: float | None = None
    off_east_m: Finite = 0.0
    off_north_m: Finite = 0.0


def write_state(path: Path, state: SimulationState, identity: Identity) -> None:
    """Write the state atomically.

    Raises:
        OutputError: The file cannot be written.
    """
    values = asdict(state) | asdict(identity)
    # JSON has no infinity: null stands for a position that is lost for good.
    values["lost"] = [(None if math.isinf(until_s) else until_s, what) for until_s, what in state.lost]
    data = _Document(format=1, **values).model_dump_json().encode()
    try:
        write_whole(path, data)
    except OSError as error:
        raise OutputError(
            f"the robot's state cannot be written: {error.strerror or error}",
            where=str(path),
            advice="choose a file in a folder that you may write to",
        ) from None


def read_state(path: Path, identity: Identity) -> SimulationState | None:
    """Read the state; return None if the file does not exist.

    Raises:
        InputError: The file cannot be read, is malformed, or belongs to another robot.
    """
    advice = "remove it, and the robot starts at the site's start marker"
    try:
        document = _Document.model_validate_json(read_file(path, _MOST_BYTES, plain=True))
    except FileFault as fault:
        if fault.kind == "missing":
            return None
        raise InputError(fault.what, where=str(path), advice="give the path of a file") from None
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        raise InputError(
            f"is not the state of a simulated robot: {key} {first['msg']}", where=str(path), advice=advice
        ) from None
    for part, given in asdict(identity).items():
        if getattr(document, part) != given:
            raise InputError(f"is the state of a robot with another {part}", where=str(path), advice=advice)
    values = document.model_dump(exclude={"format", *asdict(identity)})
    values["lost"] = tuple((math.inf if until_s is None else until_s, what) for until_s, what in document.lost)
    return SimulationState(**values)
