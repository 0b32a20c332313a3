"""Model of a site: trees, markers, zones, gates and rows, and the drives between its places."""
