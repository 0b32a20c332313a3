"""A robot over ROS 2: one driver above two transports, DDS without any ROS installed, and rclpy where ROS is sourced.

Driver ──▶ actions, services, topics of the profile ──▶ Transport ──▶ dds | rclpy ──▶ the robot, or its twin
"""
