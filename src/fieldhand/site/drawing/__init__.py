"""Pictures of a site, in local metres: a base map for other drawings, and the picture of the site itself."""

from fieldhand.site.drawing.choices import save_choices_picture
from fieldhand.site.drawing.ground import TREE_COLOUR, draw_site, site_figure, tree_size
from fieldhand.site.drawing.names import name_site
from fieldhand.site.drawing.picture import save_site_picture, site_picture

__all__ = [
    "TREE_COLOUR",
    "draw_site",
    "name_site",
    "save_choices_picture",
    "save_site_picture",
    "site_figure",
    "site_picture",
    "tree_size",
]
