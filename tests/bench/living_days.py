#!/usr/bin/python3
"""Forty days of the sample factory on one memory and one living map: pallets and clutter anew each day, an aisle closed
every second day, walls of the building moved on days 10, 20 and 30 (the drawing stays as it was).

    living_days.py MADORI SOAK DATA FOLDER [--days 40] [--orders 160] [--still] [--seed 1]
    living_days.py MADORI SOAK DATA FOLDER --report       the table of what was driven so far

`--still`: no wall moves. Site, scenarios, memory, map and the figures of each day (days.json) are kept in FOLDER. The columns: deliveries made
of those asked for; how often a person helped; contacts while moving; the pose's error, mean and most, metres; the map at the
day's end against what stood that day (tests/end_to_end/soak/map_truth.hpp): precision and recall of the static and of the semi-static
layer; cells read as moving, of a thousand known; megabytes of the map's file.
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "end_to_end")]
import sample_site  # noqa: E402

# from that day on, in lines of the scenario's building
CHANGES = {
    0: "",
    10: ", moved_walls: [{ids: [33, 34, 35, 36], dx_m: 0.3, dy_m: -0.2}]",
    20: ", moved_walls: [{ids: [33, 34, 35, 36], dx_m: 0.3, dy_m: -0.2}], missing_walls: [29, 30, 31, 32]",
    30: ", moved_walls: [{ids: [33, 34, 35, 36], dx_m: -0.4, dy_m: 0.3}], missing_walls: [29, 30, 31, 32],"
        " added_walls: [{line: [[14, 9.5], [14, 12]]}]",
}


def prepare(a):
    site = a.folder / "site"
    if not (site / "site.yaml").exists():
        sample_site.make_site(a.madori, a.data, site, "scan")
    scenario = sample_site.soak_scenario(a.data)
    for day, change in CHANGES.items():
        text = scenario.replace("ceiling_height_m: 6.0}", f"ceiling_height_m: 6.0{change}}}")
        if change and text == scenario:
            sys.exit("the scenario's building is not where it was")
        (a.folder / f"from_day_{day}.yaml").write_text(text)
    return site


def drive(a):
    a.folder.mkdir(parents=True, exist_ok=True)
    site = prepare(a)
    for name in ("memory", "map"):
        shutil.rmtree(a.folder / name, ignore_errors=True)
        (a.folder / name).mkdir()
    (a.folder / "days.json").unlink(missing_ok=True)
    for day in range(a.days):
        since = 0 if a.still else max(d for d in CHANGES if d <= day)
        with open(a.folder / "days.log", "a", encoding="utf-8") as log:
            subprocess.run([a.soak, site, a.folder / f"from_day_{since}.yaml", "--routes", a.data / "scenarios/soak/routes",
                            "--orders", str(a.orders), "--days", str(a.days), "--first-day", str(day), "--end-day",
                            str(day + 1), "--seed", str(a.seed), "--crossings", "0.2", "--memory", a.folder / "memory",
                            "--living-map", a.folder / "map", "--json", a.folder / "days.json"],
                           stdout=log, stderr=subprocess.STDOUT, check=False)
        report(a, day)


def report(a, only=None):
    if only in (None, 0):
        print("day  made   helps  hits   pose mean  most   static p      r   semi-static p      r   moving  MB", flush=True)
    with open(a.folder / "days.json", encoding="utf-8") as lines:
        for line in lines:
            f = json.loads(line)
            if only is not None and f["day"] != only:
                continue
            m, pose = f["living_map"], f["pose_error"]
            print(f"{f['day']:3d}  {f['delivered']:2d}/{f['asked']:2d}  {len(f['help']):5d}  {len(f['collisions_moving']):4d}   "
                  f"{pose['sum_m'] / max(1, pose['count']):9.4f}  {pose['most_m']:4.2f}   "
                  f"{m['static']['precision']:8.3f}  {m['static']['recall']:5.3f}   {m['semi_static']['precision']:13.3f}  "
                  f"{m['semi_static']['recall']:5.3f}   {1000 * m['moving'] / m['known']:6.2f}  {m['file_bytes'] / 1e6:.1f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("madori", type=pathlib.Path)
    parser.add_argument("soak", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--days", type=int, default=40)
    parser.add_argument("--orders", type=int, default=160)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--still", action="store_true")
    parser.add_argument("--report", action="store_true")
    a = parser.parse_args()
    a.madori, a.soak = a.madori.resolve(), a.soak.resolve()
    if a.report:
        report(a)
    else:
        drive(a)


if __name__ == "__main__":
    main()
