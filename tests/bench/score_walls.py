#!/usr/bin/python3
"""Scores wall detection against hand-made truth, beside two baselines in the same run.

  cmake --build build/release --target bench_detect_walls && tests/bench/score_walls.py

Methods: madori; otsu-hough (Otsu's threshold, then OpenCV's HoughLinesP on the whole picture); lsd (OpenCV's line
segment detector). The scale of a drawing is the mean of its measurements.csv, or scale.txt. The score itself is
../shared/score/walls.py (tolerance 0.15 m); without that folder only the sample factory's truth exists and the
script says so and ends."""
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared"
BENCH = ROOT / "build/release/tests/bench/bench_detect_walls"
SCORER = SHARED / "score/walls.py"
METHODS = ("madori", "otsu-hough", "lsd")


def scale_of(folder):
    measurements = folder / "measurements.csv"
    if not measurements.exists():
        return float((folder / "scale.txt").read_text().split()[0])
    with open(measurements, newline="", encoding="utf-8") as file:
        rows = [[float(row[k]) for k in ("u1", "v1", "u2", "v2", "metres")] for row in csv.DictReader(file)]
    return sum(m / math.hypot(u2 - u1, v2 - v1) for u1, v1, u2, v2, m in rows) / len(rows)


def drawings():
    factory = ROOT / "data/sample_factory"
    yield "sample_factory", factory / "factory_scan.png", factory / "true_walls_scan_px.csv", 0.025
    for truth in sorted(SHARED.glob("data/drawings/*/walls.csv")):
        folder = truth.parent
        yield folder.name, folder / f"{folder.name}.png", truth, scale_of(folder)


def score(picture, truth, scale, method, folder):
    walls = folder / "walls.csv"
    subprocess.run([BENCH, picture, "--scale", str(scale), "--out", walls, "--method", method],
                   check=True, stdout=subprocess.DEVNULL)
    answer = subprocess.run(["/usr/bin/python3", SCORER, "--truth", truth, "--drawing", picture, "--detected", walls,
                             "--scale", str(scale), "--json", "-"], check=True, capture_output=True, text=True)
    return json.loads(answer.stdout)


def main():
    if not SCORER.exists():
        print(f"skipped: {SCORER} is not there")
        return
    if not BENCH.exists():
        sys.exit(f"{BENCH} is not built: cmake --build build/release --target bench_detect_walls")
    print(f"{'drawing':20} {'method':11} {'precision':>9} {'recall':>7} {'F1':>6} {'found/true length':>18}")
    with tempfile.TemporaryDirectory() as temporary:
        for name, picture, truth, scale in drawings():
            for method in METHODS:
                s = score(picture, truth, scale, method, pathlib.Path(temporary))
                print(f"{name:20} {method:11} {s['precision']:9.3f} {s['recall']:7.3f} {s['f1']:6.3f} "
                      f"{s['detected_m'] / s['truth_m']:18.2f}", flush=True)


if __name__ == "__main__":
    main()
