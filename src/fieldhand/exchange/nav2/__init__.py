"""Files for the servers of Nav2 from one site: maps, masks of costmap filters, and a graph of routes.

frame          the map frame in which everything is written
grid           cells of a map that lines touch and polygons cover
ground         the ground of a site as shapes in the map frame
maps           images and YAML files of ``map_server``, and the masks of the filters
route_graph    the drives of a site as a graph for ``nav2_route``
approved_path  the planned path of a mission as ``nav_msgs/msg/Path``
parameters     parameters of the servers that load these files
writing        all of them
"""

from fieldhand.exchange.nav2.writing import MapOptions, Nav2Files, export_nav2

__all__ = ["MapOptions", "Nav2Files", "export_nav2"]
