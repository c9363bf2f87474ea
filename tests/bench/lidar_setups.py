#!/usr/bin/python3
"""Deliveries with other lidars: the soak of driving-figures.md, driven with each of the setups below, one row a setup.

    lidar_setups.py MADORI SOAK DATA FOLDER [--setups lms,two_s300] [--orders 100] [--days 5] [--kidnappings 10] [--seed 1]
                    [--jobs 1]
    lidar_setups.py MADORI SOAK DATA FOLDER --report       the table of what was driven so far

Sites, scenarios and of each day the figures (SETUP.DAY.json) and what the soak says (SETUP.DAY.log) are kept in FOLDER.
Days are shared out to so many jobs. SIGTERM to a soak ends it after the delivery under way and keeps its figures.
"""
import argparse
import concurrent.futures
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "end_to_end"), str(HERE.parent / "end_to_end/soak")]
import report  # noqa: E402
import sample_site  # noqa: E402

THIRD = "keep_every_firing: 3"
FIELD = "protective_m: 0.7, protective_side_m: 0.05"  # as the virtual scanners are configured
TOP = "type: vlp16, x_m: 0.3, z_m: {}"
# name: (what the table calls it, lidars of site.yaml, sections of the scenario)
SETUPS = {
    "vlp_12": ("VLP-16 at 1.2 m", [TOP.format(1.2)], [f"vlp16: {{{THIRD}}}"]),
    "vlp_08": ("VLP-16 at 0.8 m", [TOP.format(0.8)], [f"vlp16: {{{THIRD}}}"]),
    "vlp_16": ("VLP-16 at 1.6 m", [TOP.format(1.6)], [f"vlp16: {{{THIRD}}}"]),
    "vlp_22": ("VLP-16 at 2.2 m", [TOP.format(2.2)], [f"vlp16: {{{THIRD}}}"]),
    "vlp_tilt": ("VLP-16 at 1.2 m, leaning 1 deg forward, which site.yaml does not say", [TOP.format(1.2)],
                 [f"vlp16: {{{THIRD}, pitch_deg: 1}}"]),
    "vlp_roll": ("VLP-16 at 1.2 m, leaning 1 deg to the right, likewise", [TOP.format(1.2)],
                 [f"vlp16: {{{THIRD}, roll_deg: 1}}"]),
    "lms": ("LMS111 alone, 50 Hz, 0.25 m high", ["type: lms1xx, x_m: 0.75, z_m: 0.25"], []),
    "two_s300": ("two S300 at opposite corners, 0.15 m high",
                 [f"type: s300, x_m: 0.75, y_m: 0.25, z_m: 0.15, yaw_deg: 45, {FIELD}",
                  f"type: s300, x_m: -0.15, y_m: -0.25, z_m: 0.15, yaw_deg: -135, address: /dev/ttyUSB2, {FIELD}"], []),
}


def prepare(a, name):
    _, lidars, sections = SETUPS[name]
    site = a.folder / name
    if not (site / "site.yaml").exists():
        sample_site.make_site(a.madori, a.data, site, "scan")
    sample_site.mount(site, lidars)
    scenario = sample_site.soak_scenario(a.data)
    for section in sections:
        scenario = sample_site.set_section(scenario, section)
    (site / "soak.yaml").write_text(scenario)


def drive(a, name, day):
    figures = a.folder / f"{name}.{day}.json"
    figures.unlink(missing_ok=True)
    with open(a.folder / f"{name}.{day}.log", "w", encoding="utf-8") as log:
        subprocess.run([a.soak, a.folder / name, a.folder / name / "soak.yaml", "--routes", a.data / "scenarios/soak/routes",
                        "--orders", str(a.orders), "--days", str(a.days), "--first-day", str(day), "--end-day", str(day + 1),
                        "--kidnappings", str(a.kidnappings), "--seed", str(a.seed), "--json", figures],
                       stdout=log, stderr=subprocess.STDOUT, check=False)


def row(title, days):
    add = lambda key: sum(day[key] for day in days)
    every = lambda key: [entry for day in days for entry in day[key]]
    off, goal, pose = (report.spread(days, key) for key in ("off_route", "goal_error", "pose_error"))
    found = sorted(every("found_after_s"))
    in_vain = sum(not h["every_way_blocked"] for h in every("help"))
    return " | ".join([
        f"| {title}", f"{add('delivered')} of {add('asked')}", f"{len(every('collisions_moving'))}", f"{in_vain}",
        f"{goal['within_2cm']} within 0.02 m, most {goal['most']:.3f} m",
        f"{sum(d <= 1.0 for d in every('goal_error_deg'))} of {len(every('goal_error_deg'))}",
        f"mean {off['mean']:.4f} m, p99 {off['p99']:.3f} m, most {off['most']:.3f} m",
        f"mean {pose['mean']:.4f} m, wrong {add('sure_but_wrong_s'):.1f} s",
        f"{len(found)} of {add('kidnapped')}" + (f", {found[len(found) // 2]:.1f} s, longest {found[-1]:.1f} s" if found else ""),
        f"{add('simulated_s') / max(add('cpu_s'), 1e-9):.0f} x |"])


def table(folder, names):
    print("| lidar | delivered | contacts | help | stops | within 1 deg | from the route | pose | kidnappings found | speed |")
    print("|" + " --- |" * 10)
    for name in names:
        days = [json.loads(line) for file in sorted(folder.glob(f"{name}.*.json")) for line in file.read_text().splitlines()]
        if days:
            print(row(SETUPS[name][0], days))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("madori", type=pathlib.Path)
    parser.add_argument("soak", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--setups", default=",".join(SETUPS), help=f"of {', '.join(SETUPS)}")
    parser.add_argument("--orders", type=int, default=100)
    parser.add_argument("--days", type=int, default=5)
    parser.add_argument("--kidnappings", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="days that are driven at the same time")
    parser.add_argument("--report", action="store_true")
    a = parser.parse_args()
    names = a.setups.split(",")
    unknown = [name for name in names if name not in SETUPS]
    if unknown:
        parser.error(f"no setup is called {', '.join(unknown)}; there are {', '.join(SETUPS)}")
    a.folder.mkdir(parents=True, exist_ok=True)
    if not a.report:
        for name in names:
            prepare(a, name)
        with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
            for job in [pool.submit(drive, a, name, day) for day in range(a.days) for name in names]:
                job.result()
    table(a.folder, names)


if __name__ == "__main__":
    main()
