"""A simulated ROS 2 robot without ROS: serves what a robot's profile binds, over any transport.

    requests ──▶ navigation_server, capture_servers ──▶ robot_platform ──▶ SimulatedDriver (site, world file, seed)
                                                              │
    topics   ◀── telemetry_topics, sensor_topics ◀────────────┘

- ``robot``: :class:`SimulatedRobot`, the whole robot; its owner calls ``step`` repeatedly.
- ``action_server``: server of a ROS action, from goal request to result.
- ``navigation_server``: the Nav2 action that the profile names; ``speed_limit``: its maximum speed.
- ``navigator``: Nav2's navigator, which a world can have die; ``controller_server``: its controller, which drives on;
  ``lifecycle_servers``: the states of their nodes.
- ``capture_servers``: actions and services that the profile's actions are bound to; ``sensor_topics``: sensor topics.
- ``telemetry_topics``: battery, fix, odometry, emergency stop.
- ``robot_platform``: the simulated vehicle, one activity at a time; ``place_lookup``: the place that a request means.
- ``field_values``: readings as message fields.
- ``state_file``: file from which the robot continues after a restart; ``main_loop``: runs it in real time.
"""
