"""Record transcripts of the llm planner as test data, one file per request.

    record_transcripts.py OUT --cases CASES.yaml [--only ID ...] --base-url URL [--model NAME] [--note TEXT]

CASES.yaml lists requests (``cases: [{id, request, site?, robot?}]``, with ``site`` and ``robot`` for all of them at the
top; sites are relative to the file). The endpoint may be any OpenAI-compatible one, including one operated by a person
or by a program of your own. If it requires a key, set FIELDHAND_API_KEY.
"""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import replace
from pathlib import Path

import yaml

from fieldhand.errors import FieldhandError
from fieldhand.planning.llm.replay import record
from fieldhand.planning.llm.settings import require_settings
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site


def main() -> int:
    """Record each case; return the number of cases without an outcome, 125 at most."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--cases", type=Path, required=True)
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--base-url", required=True)
    parser.add_argument("--model", default="by-hand")
    parser.add_argument("--note", default="")
    parser.add_argument("--timeout", type=float, default=900.0)
    args = parser.parse_args()
    settings = require_settings(os.environ, model=f"openai-compatible:{args.model}", base_url=args.base_url)
    settings = replace(settings, timeout_s=args.timeout)
    document = yaml.safe_load(args.cases.read_text(encoding="utf-8"))
    failed = 0
    for case in document["cases"]:
        if args.only and case["id"] not in args.only:
            continue
        site = open_site(str(args.cases.parent / case.get("site", document.get("site", ""))))
        robot = load_robot(case.get("robot", document.get("robot", "husky")))
        try:
            path = args.out / f"{case['id']}.jsonl"
            outcome = record(case["request"], site, robot, path, settings=settings, note=args.note)
            print(f"{case['id']}: {type(outcome).__name__}")
        except FieldhandError as error:
            failed += 1
            print(f"{case['id']}: {error}", file=sys.stderr)
    return min(failed, 125)


if __name__ == "__main__":
    sys.exit(main())
