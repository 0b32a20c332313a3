"""Driver for robots over ROS 2, above two transports: DDS (no ROS installed) and rclpy (where ROS is sourced).

Driver ──▶ actions, services, topics of the profile ──▶ Transport ──▶ dds | rclpy ──▶ the robot, or the simulated robot
"""
