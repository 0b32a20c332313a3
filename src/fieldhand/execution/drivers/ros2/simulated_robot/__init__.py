"""A simulated ROS 2 robot without ROS: serves what a robot's profile binds, above any transport.

    requests ──▶ navigation, captures ──▶ body ──▶ SimulatedDriver (site, world file, seed)
                                            │
    topics   ◀── senses, feeds ◀────────────┘

- ``robot``: :class:`SimulatedRobot`, all of it; whoever has it calls ``step`` again and again.
- ``action_server``: the server of a ROS action, from the request of a goal to its result.
- ``navigation``: the action of Nav2 that the profile names; ``limit``: how fast it may drive.
- ``captures``: the actions and services that the profile binds its actions to; ``feeds``: the topics.
- ``senses``: battery, fix, odometry, emergency stop, ``/clock``.
- ``platform``: the robot beneath, which does one thing at a time; ``ground``: which place is meant.
- ``state``: the file by which it goes on where it stood; ``serving``: runs it in real time.
"""
