"""The process that carries out the mission of one simulated robot: ``python -m fieldhand.fleet.worker FOLDER``.

It resumes where the mission was cut off, and writes the report at the end. A termination request ends it at once, like
a power cut: the journal is complete, and the mission can be resumed.
"""

from __future__ import annotations

import math
import os
import signal
import sys
import time
import traceback
from collections.abc import Callable
from contextlib import closing
from datetime import datetime
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from fieldhand.compatibility import UTC
from fieldhand.errors import FieldhandError
from fieldhand.fleet.worker_folder import PositionFile, SeenPosition, WorkerFolder, at_most_every

if TYPE_CHECKING:
    from fieldhand.execution.vehicle import Vehicle
    from fieldhand.missions import StoredMission

#: Seconds between two positions.
POSITION_EVERY_S = 0.2


def main(folder: Path) -> int:
    """Carry out the mission of a folder, and return the exit status."""
    signal.signal(signal.SIGTERM, _leave)
    worker = WorkerFolder(folder)
    try:
        worker.set_fault("")
        _carry_out(folder, worker)
    except FieldhandError as error:
        worker.set_fault(str(error))
        return 1
    except Exception as error:  # noqa: BLE001  a fault of the program, which the page names and the log describes
        traceback.print_exc()
        worker.set_fault(f"an internal error: {type(error).__name__}")
        return 1
    return 0


def _leave(number: int, frame: FrameType | None) -> None:  # noqa: ARG001  the signature that signal wants
    os._exit(0)


def _carry_out(folder: Path, worker: WorkerFolder) -> None:
    from fieldhand import missions
    from fieldhand.approval.production import require_unsigned_allowed
    from fieldhand.execution.drivers.simulation.vehicle import simulation

    require_unsigned_allowed(os.environ)
    settings = worker.settings()
    stored = missions.open_mission(folder)
    missions.require_vehicle(stored.id, stored.started_on, simulated=True)
    if missions.status(folder).now.state != "ended":
        vehicle = simulation(stored.site, stored.robot, stored.world, seed=stored.seed, speed=settings.speed)
        with closing(PositionFile(worker.position_file)) as file:
            missions.carry_out(stored, vehicle=vehicle, emit=lambda _: None, interrupted=_position_notes(vehicle, file))
    _conclude(stored)


def _position_notes(vehicle: Vehicle, file: PositionFile) -> Callable[[], None]:
    """Return a function that is polled while the mission runs, and notes the robot's position."""
    due = at_most_every(POSITION_EVERY_S, time.monotonic)

    def poll() -> None:
        if not due():
            return
        at = vehicle.driver.position()
        if not (math.isfinite(at.lat) and math.isfinite(at.lon)):
            return
        file.write(
            SeenPosition(
                t=vehicle.clock.now(),
                lat=at.lat,
                lon=at.lon,
                heading_deg=at.heading_deg,
                charge_percent=vehicle.driver.charge_percent(),
                at=datetime.now(UTC).isoformat(timespec="milliseconds"),
            )
        )

    return poll


def _conclude(stored: StoredMission) -> None:
    """Write the report of a mission that has ended, and record its cost for calibration."""
    from fieldhand import finished_missions, mission, missions

    finished_missions.conclude(
        stored.authorized,
        stored.site,
        stored.robot,
        missions.events_of(stored.folder),
        estimate=mission.review(stored.authorized.task, stored.site, stored.robot).estimate,
        folder=stored.folder,
        history=finished_missions.history_folder(os.environ),
        at=datetime.now(UTC),
        images=stored.folder,
    )


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
