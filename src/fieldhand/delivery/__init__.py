"""A signed mission on its way to a robot, and what the robot does with it, whatever happens to the link between them.

sender:  bundle ──▶ Outbox ──▶ RobotClient ─ ─ ─▶ MissionStore ──▶ MissionSupervisor ──▶ a mission's folder     :robot
                      ▲ later     │ ◀─ ─ ─ hashes, state, events ◀──┘
                      └───────────┘
"""
