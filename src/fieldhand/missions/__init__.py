"""Missions that outlast a power cut: each has a folder with all that it needs, and the journal of what it did.

begin ──▶ folder ──carry_out──▶ events          status and order: from any other process, at any moment
                     ▲    │ power cut
                     └────┘

    task.xml, site/…, robot.yaml, world.yaml, mission.json    what the mission is
    journal.sqlite, journal.mark, events.jsonl                what was done
    report.html, observations.csv, observations.geojson       what came of it, where a robot's agent carried it out
    orders.sqlite                                             what people want
"""

from fieldhand.missions.direct_commands import DirectCommands
from fieldhand.missions.find_mission import all_missions, exists, find, missions_folder
from fieldhand.missions.folder import (
    Departure,
    FolderContents,
    Inputs,
    StoredMission,
    begin,
    departure_on,
    new_id,
    open_mission,
    read_folder,
    signed_inputs,
)
from fieldhand.missions.mission_status import (
    Status,
    carry_out,
    events_of,
    is_running,
    last_order,
    lines_after,
    order,
    require_vehicle,
    stands_still,
    status,
)
from fieldhand.missions.start_checks import require_charged, require_in_place

__all__ = [
    "Departure",
    "DirectCommands",
    "FolderContents",
    "Inputs",
    "Status",
    "StoredMission",
    "all_missions",
    "begin",
    "carry_out",
    "departure_on",
    "events_of",
    "exists",
    "find",
    "is_running",
    "last_order",
    "lines_after",
    "missions_folder",
    "new_id",
    "open_mission",
    "order",
    "read_folder",
    "require_charged",
    "require_in_place",
    "require_vehicle",
    "signed_inputs",
    "stands_still",
    "status",
]
