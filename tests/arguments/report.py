"""What becomes of mistakes in arguments, in numbers and in full: python tests/arguments/report.py [package …]"""

from __future__ import annotations

import faulthandler
import json
import subprocess
import sys
import time
from collections import Counter, defaultdict
from pathlib import Path

KINDS = ("clear", "cryptic", "ignored", "accepted", "nan out", "slow", "lost")
DEADLY = 90
"""Seconds after which a call that can't be interrupted ends its process."""


def tried(package: str) -> None:
    """Print a line of JSON for each outcome in a package."""
    from calls import CALLS
    from runner import outcomes, variants

    for key in CALLS:
        if key.startswith(f"{package}."):
            print(json.dumps({"begin": key}), flush=True)
            faulthandler.dump_traceback_later(DEADLY, exit=True)
            began = time.perf_counter()
            for what, found in (("mistake", outcomes(key)), ("variant", variants(key))):
                for outcome in found:
                    print(json.dumps({"key": key, "what": what, **outcome._asdict()}), flush=True)
            faulthandler.cancel_dump_traceback_later()
            print(json.dumps({"end": key, "seconds": time.perf_counter() - began}), flush=True)


def collected(packages: list[str]) -> tuple[list[dict], dict[str, float]]:
    """Outcomes of all packages, each in a process of its own, and the time that each callable took."""
    rows, seconds = [], {}
    for package in packages:
        done = subprocess.run(
            [sys.executable, __file__, "--try", package], stdout=subprocess.PIPE, text=True, check=False
        )
        open_key = None
        for line in done.stdout.splitlines():
            row = json.loads(line)
            if "begin" in row:
                open_key = row["begin"]
            elif "end" in row:
                open_key, seconds[row["end"]] = None, row["seconds"]
            else:
                rows.append(row)
        if open_key or done.returncode:
            lost = {"parameter": "?", "mistake": "?", "kind": "lost", "message": f"ended with {done.returncode}"}
            rows.append({"key": open_key or package, "what": "mistake", **lost})
    return rows, seconds


def show(rows: list[dict], seconds: dict[str, float]) -> None:
    wrong, variants = ([row for row in rows if row["what"] == what] for what in ("mistake", "variant"))
    print(f"{len({row['key'].split(':')[0] for row in wrong})} callables, "
          f"{len({(row['key'].split(':')[0], row['parameter']) for row in wrong})} parameters, "
          f"{len(wrong)} mistakes, {len(variants)} rightful variants; {sum(seconds.values()):.0f} s\n")  # fmt: skip
    total("all", wrong)
    for package in dict.fromkeys(row["key"].split(".")[0] for row in wrong):
        total(package, [row for row in wrong if row["key"].startswith(f"{package}.")])
    print("\nNot clear, by mistake")
    counts = Counter(row["mistake"] for row in wrong if row["kind"] != "clear")
    of = Counter(row["mistake"] for row in wrong)
    for mistake, count in counts.most_common():
        print(f"{count:6} of {of[mistake]:5}  {mistake}")
    print("\nVariants that are refused, or give something else")
    print("  ".join(f"{kind}: {count}" for kind, count in Counter(row["kind"] for row in variants).items()))
    print(
        "\nSlowest:",
        ", ".join(f"{key} {took:.1f} s" for key, took in sorted(seconds.items(), key=lambda x: -x[1])[:12]),
    )
    by_key = defaultdict(list)
    for row in rows:
        by_key[row["key"]].append(row)
    for key, found in by_key.items():
        bad = [row for row in found if row["kind"] not in ("clear", "same")]
        if bad:
            print(f"\n{key}: {len(bad)} of {len(found)}")
            for row in bad:
                way = "as" if row["what"] == "variant" else "="
                print(f"  {row['parameter']} {way} {row['mistake']} → {row['kind']}: {row['message']}")


def total(name: str, rows: list[dict]) -> None:
    counts = Counter(row["kind"] for row in rows)
    shares = "  ".join(f"{kind} {100 * counts[kind] / len(rows):5.1f} %" for kind in KINDS if kind != "lost")
    lost = f"  lost {counts['lost']}" if counts["lost"] else ""
    print(f"{name:13} {len(rows):6}  {shares}{lost}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--try"]:
        tried(sys.argv[2])
    else:
        sys.path.insert(0, str(Path(__file__).parent))
        from calls import MODULES, PACKAGES

        show(*collected(sys.argv[1:] or [*PACKAGES, *MODULES]))
