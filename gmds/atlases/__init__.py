"""One triangulation for a whole collection: templates, registered specimens, their mean shape, in a folder"""

from gmds.atlases.build import atlas
from gmds.atlases.registered import Atlas

__all__ = ["Atlas", "atlas"]
