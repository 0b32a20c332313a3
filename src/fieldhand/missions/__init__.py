"""Stored missions: each has a folder with its inputs and a journal, so that it survives a power cut.

begin ──▶ folder ──carry_out──▶ events          status and send_command: from any other process, at any time
                     ▲    │ power cut
                     └────┘

    task.xml, site/…, robot.yaml, world.yaml, mission.json    inputs
    journal.sqlite, journal.mark, events.jsonl                journal and event log
    report.html, observations.csv, observations.geojson       report, if a robot's agent carried the mission out
    orders.sqlite                                             commands of operators
"""

from fieldhand.missions.carry_out import carry_out, require_vehicle
from fieldhand.missions.direct_commands import DirectCommands
from fieldhand.missions.earlier_missions import earlier_missions
from fieldhand.missions.find_mission import all_missions, exists, find, missions_folder
from fieldhand.missions.folder import (
    FolderContents,
    Inputs,
    RobotAtStart,
    StoredMission,
    begin,
    new_id,
    open_mission,
    read_folder,
    robot_at_start,
    signed_inputs,
)
from fieldhand.missions.images import image_of
from fieldhand.missions.mission_status import (
    Status,
    events_of,
    is_running,
    lines_after,
    stands_still,
    status,
)
from fieldhand.missions.send_command import has_received_all, last_command, send_command
from fieldhand.missions.start_checks import require_charged, require_in_place

__all__ = [
    "DirectCommands",
    "FolderContents",
    "Inputs",
    "RobotAtStart",
    "Status",
    "StoredMission",
    "all_missions",
    "begin",
    "carry_out",
    "earlier_missions",
    "events_of",
    "exists",
    "find",
    "has_received_all",
    "image_of",
    "is_running",
    "last_command",
    "lines_after",
    "missions_folder",
    "new_id",
    "open_mission",
    "read_folder",
    "require_charged",
    "require_in_place",
    "require_vehicle",
    "robot_at_start",
    "send_command",
    "signed_inputs",
    "stands_still",
    "status",
]
