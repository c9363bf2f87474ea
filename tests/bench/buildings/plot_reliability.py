#!/usr/bin/python3
"""Plots what `bench_buildings --random --samples FILE` has written: how often a pose was right (0.5 m, 10 degrees)
against how sure the localizer said it was, and errors and states against how far the drawing is bent.

    plot_reliability.py samples.csv plot.png
"""
import argparse
import collections
import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

RIGHT_M, RIGHT_DEG = 0.5, 10.0
STATES = ["LOCALIZED", "DEGRADED", "AMBIGUOUS", "LOST"]


def load(path):
    """Samples by (amplitude, sensor): arrays said, error_m, error_deg, and a list of states; seeds for the spread."""
    groups = collections.defaultdict(lambda: collections.defaultdict(list))
    with open(path) as file:
        for row in csv.DictReader(file):
            group = groups[(float(row["amplitude_m"]), row["sensor"])]
            for key in ("said", "error_m", "error_deg"):
                group[key].append(float(row[key]))
            group["state"].append(row["state"])
            group["seed"].append(int(row["seed"]))
    return {key: {name: np.array(values) for name, values in group.items()} for key, group in sorted(groups.items())}


def right(group):
    return (group["error_m"] <= RIGHT_M) & (group["error_deg"] <= RIGHT_DEG)


def reliability(groups):
    """(said, right, one sigma over drives, samples) of each tenth of what was said, all groups together."""
    said = np.concatenate([g["said"] for g in groups])
    is_right = np.concatenate([right(g) for g in groups])
    drive = np.concatenate([g["seed"] + 10**6 * i for i, g in enumerate(groups)])
    rows = []
    edges = np.append(np.linspace(0.0, 0.9, 10), [0.95, 1.0 + 1e-9])
    for low, high in zip(edges[:-1], edges[1:]):
        inside = (said >= low) & (said < high)
        if not inside.any():
            continue
        drives = np.unique(drive[inside])  # samples of one drive are not independent
        shares = [is_right[inside & (drive == d)].mean() for d in drives]
        spread = np.std(shares) / np.sqrt(len(drives))
        rows.append((said[inside].mean(), is_right[inside].mean(), spread, int(inside.sum())))
    return np.array(rows)


def plot_curve(axes, groups):
    axes.plot([0, 1], [0, 1], color="0.7", linestyle="--")
    for sensor in sorted({key[1] for key in groups}):
        rows = reliability([g for key, g in groups.items() if key[1] == sensor])
        axes.errorbar(rows[:, 0], rows[:, 1], yerr=rows[:, 2], marker="o", label=sensor)
        for said, share, sigma, count in rows:
            print(f"{sensor}: said {100 * said:5.1f} %, right {100 * share:5.1f} +- {100 * sigma:.1f} %, {int(count)} samples")
    axes.set(xlabel="said", ylabel="right within 0.5 m and 10 degrees", xlim=(0, 1), ylim=(0, 1), title="reliability")
    axes.legend()


def plot_errors(axes, groups):
    for sensor in sorted({key[1] for key in groups}):
        own = {key[0]: g for key, g in groups.items() if key[1] == sensor}
        for share, style in ((50, "-o"), (95, "--s")):
            axes.plot(list(own), [np.percentile(g["error_m"], share) for g in own.values()], style,
                      label=f"{sensor}, {share} %")
    axes.set(xlabel="bend of the drawing [m]", ylabel="error on the drawing [m]", yscale="log", title="error")
    axes.legend()


def plot_states(axes, groups):
    keys = list(groups)
    bottom = np.zeros(len(keys))
    for state, colour in zip(STATES, ("#2a7f3f", "#d9a400", "#4a7fc1", "#b03030")):
        shares = np.array([np.mean(groups[key]["state"] == state) for key in keys])
        axes.bar(range(len(keys)), shares, bottom=bottom, color=colour, label=state)
        bottom += shares
    axes.set_xticks(range(len(keys)), [f"{a:g} m\n{sensor}" for a, sensor in keys], fontsize=7)
    axes.set(ylabel="share of the time", title="health")
    axes.legend(loc="lower left")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("samples")
    parser.add_argument("plot")
    arguments = parser.parse_args()
    groups = load(arguments.samples)
    figure, axes = plt.subplots(1, 3, figsize=(15, 4.6), layout="constrained")
    plot_curve(axes[0], groups)
    plot_errors(axes[1], groups)
    plot_states(axes[2], groups)
    figure.savefig(arguments.plot, dpi=110)


if __name__ == "__main__":
    main()
