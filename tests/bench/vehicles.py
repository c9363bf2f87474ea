#!/usr/bin/env python3
"""Vehicles that brake, answer and are shaped differently, with only site.yaml changed: deliveries and test bodies.

    tests/bench/vehicles.py MADORI SOAK ENCOUNTERS DATA [--deliveries 100] [--bodies 100] [--json FILE]

The virtual vehicle is `as_recorded`: it brakes and answers just as site.yaml says, no better. Every vehicle drives the
first days of the soak (docs/reference/driving-figures.md) and meets upright and lying bodies and persons.
"""
import argparse
import json
import math
import pathlib
import re
import subprocess
import tempfile

# deceleration m/s2, reaction s, length m, axle to rear m
VEHICLES = [
    (0.5, 0.40, 2.0, 0.3),
    (0.5, 0.05, 0.6, 0.3),
    (0.8, 0.25, 1.0, 0.2),
    (0.8, 0.40, 1.4, 0.7),
    (1.5, 0.05, 2.0, 1.0),
    (1.5, 0.40, 0.6, 0.1),
]
DAYS, ORDERS = 40, 1143  # the soak's own


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode not in (0, 1):  # 1: something was touched or missed; the figures say what
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def change(site, vehicle):
    deceleration, reaction, length, rear = vehicle
    text = (site / "site.yaml").read_text()
    for key, value in {"length_m": length, "base_to_rear_m": rear, "max_deceleration_mps2": deceleration,
                       "reaction_s": reaction}.items():
        text, found = re.subn(rf"(?m)^  {key}: .*$", f"  {key}: {value}", text)
        assert found == 1, key
    text, found = re.subn(r"(?m)^    x_m: .*$", f"    x_m: {round(0.5 * (length - rear), 3)}", text)
    assert found >= 1, "no sensor"
    (site / "site.yaml").write_text(text)


def as_recorded(scenario, folder):
    """The scenario beside its walls, with the vehicle that is no better than its record."""
    text = scenario.read_text()
    text = re.sub(r"(walls: )(\S+?)([,}])", lambda m: m[1] + str((scenario.parent / m[2]).resolve()) + m[3], text)
    text, found = re.subn(r"(?m)^vehicle: \{", "vehicle: {as_recorded: true, ", text)
    assert found == 1, "no vehicle"
    copy = folder / "scenario.yaml"
    copy.write_text(text)
    return copy


def measure(args, vehicle, folder):
    site = folder / "site"
    run(args.madori, "demo", "--import-only", "--site", site, "--data", args.data)
    change(site, vehicle)
    soak = args.data / "scenarios/soak"
    days = math.ceil(args.deliveries / (ORDERS / DAYS))
    report = folder / "days.json"
    run(args.soak, site, as_recorded(soak / "scenario.yaml", folder), "--routes", soak / "routes", "--orders", ORDERS,
        "--days", DAYS, "--first-day", 1, "--end-day", 1 + days, "--json", report)
    figures = [json.loads(line) for line in report.read_text().splitlines()]
    met = folder / "met.json"
    each = math.ceil(args.bodies / 3)
    run(args.encounters, site, as_recorded(args.data / "scenarios/demo.yaml", folder), "--placements", each, "--json", met)
    return figures, json.loads(met.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("madori", "soak", "encounters", "data"):
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--deliveries", type=int, default=100)
    parser.add_argument("--bodies", type=int, default=100)
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    results = []
    for vehicle in VEHICLES:
        with tempfile.TemporaryDirectory() as name:
            days, met = measure(args, vehicle, pathlib.Path(name))
        results.append({"vehicle": vehicle, "days": days, "met": met})
        print(json.dumps(results[-1]), flush=True)
    if args.json:
        args.json.write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
