#!/usr/bin/python3
"""Ten starts on a real drawing: import, localize from 0.5 m and 10 degrees off in ten directions, score.

  ten_starts.py MADORI DATA [--picture layout.png] [--starts 10]

MADORI is build/release/madori, DATA the folder with lidar2d/ and beside it score/ (../shared/data). A line a
start: the figures of score/trajectory.py (median, p95, mean heading, share within 0.5 m and 10 degrees), the
longest run of scans off by more than 2 m, the largest error while LOCALIZED and the share of the time in each
state. Needs the data folder (docs/reference/benchmarks.md)."""
import argparse
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import yaml


def poses(path):
    """-> (n, 4): t, x, y, yaw."""
    a = np.loadtxt(path)
    return np.c_[a[:, :3], 2 * np.arctan2(a[:, 6], a[:, 7])]


def on_drawing(reference, layout):
    t = yaml.safe_load(layout.read_text())["map_from_reference"]
    a = math.radians(t["yaw_deg"])
    c, s = math.cos(a), math.sin(a)
    out = reference.copy()
    out[:, 1] = c * reference[:, 1] - s * reference[:, 2] + t["x_m"]
    out[:, 2] = s * reference[:, 1] + c * reference[:, 2] + t["y_m"]
    out[:, 3] += a
    return out


def judged(truth, trajectory, health):
    """Longest run of scans off by more than 2 m, largest error while LOCALIZED."""
    estimate, states = poses(trajectory), {}
    with open(health, encoding="utf-8") as f:
        for row in csv.DictReader(f):
            states[round(float(row["timestamp"]), 3)] = row["state"]
    run = longest = 0
    worst = 0.0
    for t, x, y, _ in truth:
        i = np.argmin(abs(estimate[:, 0] - t))
        if abs(estimate[i, 0] - t) > 0.05:
            continue
        off = math.hypot(estimate[i, 1] - x, estimate[i, 2] - y)
        run = run + 1 if off > 2.0 else 0
        longest = max(longest, run)
        if states.get(round(estimate[i, 0], 3)) == "LOCALIZED":
            worst = max(worst, off)
    return longest, worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("madori")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--picture", default="layout.png")
    parser.add_argument("--starts", type=int, default=10)
    args = parser.parse_args()
    intel = args.data / "lidar2d/intel"
    truth = on_drawing(poses(intel / "reference.tum"), intel / "layout.yaml")
    with tempfile.TemporaryDirectory() as folder:
        site = f"{folder}/site"
        subprocess.run([args.madori, "import", intel / args.picture, "--scale", "0.04259", "--site", site],
                       check=True, stdout=subprocess.DEVNULL)
        print("start  median    p95  heading  within  lost  worst LOCALIZED  states", flush=True)
        for k in range(args.starts):
            a = 2 * math.pi * k / args.starts
            turn = 10.0 if k % 2 else -10.0
            start = f"{truth[0, 1] + 0.5 * math.cos(a):.3f} {truth[0, 2] + 0.5 * math.sin(a):.3f} " \
                    f"{math.degrees(truth[0, 3]) + turn:.2f}"
            out, health, report = (f"{folder}/{n}" for n in ("t.tum", "h.csv", "r.json"))
            subprocess.run([args.madori, "localize", site, "--log", intel / "intel.log", "--initial", start,
                            "--out", out, "--health", health, "--json", report],
                           check=True, stdout=subprocess.DEVNULL)
            score = json.loads(subprocess.run(
                [sys.executable, args.data.parent / "score/trajectory.py", "--estimate", out, "--reference",
                 intel / "reference.tum", "--map-from-reference", intel / "layout.yaml", "--json", "-"],
                check=True, capture_output=True, text=True).stdout)
            lost, worst = judged(truth, out, health)
            with open(report, encoding="utf-8") as f:
                state = json.load(f)["health"]
            print(f"{k:5d}  {score['position_m']['median']:6.3f} {score['position_m']['p95']:6.3f}  "
                  f"{score['heading_deg']['mean']:7.2f}  {100 * score['within']['share']:5.1f}%  {lost:4d}  "
                  f"{worst:15.3f}  {state}", flush=True)


if __name__ == "__main__":
    main()
