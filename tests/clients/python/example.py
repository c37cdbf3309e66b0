#!/usr/bin/env python3
"""Plans a scenario with a service, shows the order, and writes plan and AEM beside each other.

    python3 tests/clients/python/example.py http://127.0.0.1:8080 tests/fixtures/olivares-a.json OUT

Wants the module `slewplan`: install its wheel, or set PYTHONPATH=server/python.
"""

import argparse
import json
import sys
from pathlib import Path

from slewplan import Client, Refused


def main(address, scenario, folder):
    client = Client(address)
    try:
        job = client.submit(json.loads(Path(scenario).read_text(encoding="utf-8")))
    except Refused as refused:
        for problem in refused.problems:
            print(f"{problem['pointer']}: {problem['message']} ({problem['hint']})", file=sys.stderr)
        sys.exit(str(refused))
    job = client.wait(job["id"])
    plan = client.plan(job["id"])
    if plan["total_time_s"] is None:
        sys.exit(f"{plan['status']}: " + "; ".join(reason["message"] for reason in plan["reasons"]))
    print(f"{plan['status']}: {plan['total_time_s']:.2f} s, gap {100 * plan['relative_gap']:.2f} %")
    for passage in plan["passages"]:
        print(f"  {passage['time_s']:9.2f} s  {passage['target']}")
    for skipped in plan.get("skipped", []):
        print(f"  left out     {skipped['target']}: {skipped['reason']}")
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    (out / "plan.json").write_text(json.dumps(plan), encoding="utf-8")
    (out / "plan.aem").write_text(client.export(job["id"], "aem-kvn"), encoding="utf-8")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Plans a scenario with a service.")
    parser.add_argument("address", metavar="ADDRESS", help="of the service, as http://127.0.0.1:8080")
    parser.add_argument("scenario", metavar="SCENARIO", help="a file")
    parser.add_argument("folder", metavar="FOLDER", help="for plan.json and plan.aem")
    main(**vars(parser.parse_args()))
