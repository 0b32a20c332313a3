"""Drives that work on a whole area: swaths, headland passes, perimeters and patrols. Pure geometry in local metres.

cover        the drive over an open area, swath by swath
row_passes   the drive along all aisles of a planted area
circuits     drives around an area, and patrols along rings and lines
plan         parameters, and the plan: swaths, legs in driving order, and what they cover
headland     the ground around an area and its holes, and the passes on it
cells        parts of an area with parallel swaths, and the bearing of each
strips       the parallel swaths of a cell
order        the order and direction of the swaths
connections  the drives between swaths, with a turning radius
dubins       shortest paths with a turning radius
ground       where the robot may drive between swaths
measures     covered and missed ground, overlap, and the objectives of Fields2Cover
"""
