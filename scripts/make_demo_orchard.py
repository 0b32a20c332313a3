"""Write the built-in orchard into the package: ``python scripts/make_demo_orchard.py``."""

from __future__ import annotations

import sys

from fieldhand.site.demo_orchard import demo_orchard, to_text
from fieldhand.site.loader import demo_path

if __name__ == "__main__":
    demo_path().write_text(to_text(demo_orchard()), encoding="utf-8", newline="\n")
    sys.stdout.write(f"wrote {demo_path()}\n")
