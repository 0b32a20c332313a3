"""Delivery of signed missions to a robot, and their execution there, with a link that may fail at any time.

sender:  bundle ──▶ Outbox ──▶ RobotClient ─ ─ ▶ MissionStore ──▶ MissionSupervisor ──▶ a mission's folder   :robot
                      ▲ later     │ ◀─ ─ ─ hashes, state, events ◀──────┘
                      └───────────┘
"""
