"""Simulated robots: each mission runs in a process of its own, which survives a restart of the server.

Fleet.begin ──▶ folder of the mission ──worker──▶ journal, position, report ──MissionFeed──▶ every reader
Fleet.command ────────┘ orders
"""

from fieldhand.fleet.fleet import CommandAnswer, Fleet, FleetCommand
from fieldhand.fleet.mission_feed import FleetMission, LoggedLine, MissionFeed
from fieldhand.fleet.worker_folder import SeenPosition, WorkerSettings

__all__ = [
    "CommandAnswer",
    "Fleet",
    "FleetCommand",
    "FleetMission",
    "LoggedLine",
    "MissionFeed",
    "SeenPosition",
    "WorkerSettings",
]
