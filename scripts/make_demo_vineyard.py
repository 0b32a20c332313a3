"""Write the built-in vineyard into the package: ``python scripts/make_demo_vineyard.py``."""

from __future__ import annotations

import sys

from fieldhand.site.demo_orchard import to_text
from fieldhand.site.demo_vineyard import demo_vineyard
from fieldhand.site.loader import built_in_path

if __name__ == "__main__":
    path = built_in_path("vineyard")
    path.write_text(to_text(demo_vineyard()), encoding="utf-8", newline="\n")
    sys.stdout.write(f"wrote {path}\n")
