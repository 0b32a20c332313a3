"""Instants at which a mission may begin, from the local times of its Task; pure functions of time zone and position."""
