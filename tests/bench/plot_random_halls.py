#!/usr/bin/env python3
"""Draws what bench_random_halls wrote: error against size and noise, one colour a method; a table on stdout.

plot_random_halls.py FIGURES.csv [--plot FILE.png]
"""
import argparse
import csv
from collections import defaultdict

import numpy as np

RIGHT_M = 0.3


def table(rows):
    print("| method | noise | halls | mapped whole | within 0.3 m | off: median, worst | places found | ms a scan |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    groups = defaultdict(list)
    for row in rows:
        groups[row["method"], "all"].append(row)
        groups[row["method"], f'{float(row["noise_m"]):.2f} m'].append(row)
    for (method, noise), of in sorted(groups.items()):
        off = np.array([float(r["mean_off_m"]) for r in of])
        whole = np.array([float(r["in_map"]) > 0.95 for r in of])
        sought = [int(r["places_of_10"]) for r in of if int(r["places_of_10"]) >= 0]
        found = f"{sum(sought)} of {10 * len(sought)}" if sought else "-"
        print(f"| {method} | {noise} | {len(of)} | {whole.sum()} | {(whole & (off < RIGHT_M)).sum()} | "
              f"{np.median(off):.3f}, {off.max():.2f} m | {found} | "
              f'{np.mean([float(r["ms_per_scan"]) for r in of]):.1f} |')


def plot(rows, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    methods = sorted({r["method"] for r in rows})
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.5), sharey=True)
    for number, method in enumerate(methods):
        of = [r for r in rows if r["method"] == method]
        off = [max(float(r["mean_off_m"]), 1e-3) for r in of]
        whole = [float(r["in_map"]) > 0.95 for r in of]
        shift = 1 + 0.06 * (number - (len(methods) - 1) / 2)
        for axis, key in zip(axes, ("area_m2", "noise_m")):
            x = [float(r[key]) * shift for r in of]
            for is_whole in (True, False):
                chosen = [i for i, w in enumerate(whole) if w == is_whole]
                axis.scatter([x[i] for i in chosen], [off[i] for i in chosen], s=22, color=f"C{number}",
                             marker="o" if is_whole else "x", label=method if is_whole else None)
    for axis, label in zip(axes, ("hall, m²", "noise on x and y, m")):
        axis.set(xscale="log", yscale="log", xlabel=label)
        axis.axhline(RIGHT_M, color="0.7", lw=0.8)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("mean distance from the truth, m  (x: not all scans in the map)")
    axes[0].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("figures", nargs="+")
    parser.add_argument("--plot")
    arguments = parser.parse_args()
    rows = [row for path in arguments.figures for row in csv.DictReader(open(path)) if row["hall"] != "hall"]
    table(rows)
    if arguments.plot:
        plot(rows, arguments.plot)


if __name__ == "__main__":
    main()
