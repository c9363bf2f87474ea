#!/usr/bin/python3
"""Of lines that are said to be walls with a probability, how many are: on drawings that the model saw no source of.

  tests/bench/train_walls.py --leave-out MODELS && tests/bench/calibration.py MODELS [--picture docs/images/calibration.png]

Prints, for each tenth of probability, the length of all lines (walls or not) and the share of it that lies on a wall of the truth,
each drawing with the same weight. Only truth of the kinds faces and lines is complete. Needs build/release/tests/bench/bench_detect_walls."""
import argparse
import concurrent.futures
import csv
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from leave_one_source_out import drawings
from train_walls import ROOT

TENTHS = 10


def judged(drawing, corpus):
    """Length and true length by the tenth of probability, as shares of the drawing's lines."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "lines.csv"
        subprocess.run([ROOT / "build/release/tests/bench/bench_detect_walls", drawing.picture, "--model", drawing.model, "--lines", file],
                       check=True, stdout=subprocess.DEVNULL)
        rows = list(csv.DictReader(open(file, encoding="utf-8")))
    lengths = np.zeros((2, TENTHS))
    for tenth in range(TENTHS):
        lines = [[float(row[key]) for key in ("u1", "v1", "u2", "v2")] for row in rows
                 if min(TENTHS - 1, int(TENTHS * float(row["probability"]))) == tenth]
        lines = corpus.outside(np.array(lines).reshape(-1, 2, 2), drawing.meta.get("ignore") or [])
        if len(lines):
            precision, _, _, _ = corpus.scored(lines, drawing.truth, drawing.meta["tolerance_px"])
            length = corpus.lengths(lines).sum()
            lengths[:, tenth] = length, precision * length
    return lengths / lengths[0].sum()


def draw(shares, file):
    import matplotlib  # pylint: disable=import-outside-toplevel
    matplotlib.use("Agg")
    from matplotlib import pyplot  # pylint: disable=import-outside-toplevel
    said = (np.arange(TENTHS) + 0.5) / TENTHS
    figure, axes = pyplot.subplots(figsize=(4.5, 4.5), dpi=100)
    axes.plot([0, 1], [0, 1], color="0.6", linewidth=1)
    axes.bar(said, shares, width=0.09, color="#003296")
    axes.set(xlabel="said to be a wall with a probability of", ylabel="share of the length that is a wall", xlim=(0, 1), ylim=(0, 1))
    figure.tight_layout()
    figure.savefig(file, metadata={"Software": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("--shared", type=pathlib.Path, default=ROOT.parent / "shared", help="default ../shared")
    parser.add_argument("--picture", type=pathlib.Path)
    args = parser.parse_args()
    args.options = ""
    sys.path.insert(0, str(args.shared / "score"))
    import corpus  # pylint: disable=import-error,import-outside-toplevel
    chosen = [drawing for drawing in drawings(args, corpus) if drawing.meta["truth"] != "contours"]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        total = sum(pool.map(lambda drawing: judged(drawing, corpus), chosen)) / len(chosen)
    shares = total[1] / np.maximum(total[0], 1e-9)
    for tenth in range(TENTHS):
        print(f"{tenth / TENTHS:.1f} to {(tenth + 1) / TENTHS:.1f}: {100 * total[0][tenth]:5.1f} % of the length, "
              f"{100 * shares[tenth]:5.1f} % of that is wall")
    if args.picture:
        draw(shares, args.picture)


if __name__ == "__main__":
    main()
