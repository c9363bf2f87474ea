#!/usr/bin/python3
"""Trains the wall model of the drawing import, by one command.

  cmake --build build/release --target draughtsman train_walls && tests/bench/train_walls.py [--leave-out FOLDER]

Writes data/wall_model/wall_model.ubj from the real drawings of ../shared/data/corpus, the six older ones with truth, and
the plans of the draughtsman (seeds 1 to --plans). With --leave-out also one model for every source of the corpus that saw
none of its drawings, FOLDER/SOURCE.ubj: tests/bench/leave_one_source_out.py scores those. The same data give the same
bytes. Build again afterwards: the model is compiled in."""
import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
BENCH = ROOT / "build/release/tests/bench"
HOME_TOLERANCE_M = 0.1  # how near its truth a line of the older drawings is a wall; they are scored with 0.15 m
HOME = {"office": 0.00846, "clinic": 0.02692, "mlstruct_7db30954": 0.00474825, "mlstruct_8888a588": 0.00272847}
HOME_WEIGHT = 1.0


def source_of(meta):
    return meta["repository"].replace("/", "_")


def rows(data):
    for file in sorted(data.glob("corpus/*/meta.yaml")):
        meta = yaml.safe_load(file.read_text(encoding="utf-8"))
        boxes = " ".join(str(value) for box in meta.get("ignore") or [] for value in box)
        yield (meta["name"], source_of(meta), 1, file.parent / meta["drawing"], file.parent / "walls.csv",
               meta["tolerance_px"], meta["truth"], boxes)
    for name, scale in HOME.items():
        folder = data / "drawings" / name
        yield name, "home", HOME_WEIGHT, folder / f"{name}.png", folder / "walls.csv", HOME_TOLERANCE_M / scale, "faces", ""
    factory = ROOT / "data/sample_factory"
    yield ("sample_factory", "home", HOME_WEIGHT, factory / "factory_scan.png", factory / "true_walls_scan_px.csv", 4,
           "faces", "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plans", type=int, default=80, help="of the draughtsman, default %(default)s")
    parser.add_argument("--leave-out", type=pathlib.Path, help="folder for the models that miss one source each")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "data/wall_model/wall_model.ubj")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data", help="default ../shared/data")
    args = parser.parse_args()
    if not (args.data / "corpus").exists():
        sys.exit(f"train_walls.py: {args.data / 'corpus'} is not there")
    with tempfile.TemporaryDirectory() as temporary:
        subprocess.run([BENCH / "draughtsman", temporary, "--plans", str(args.plans)], check=True)
        with open(pathlib.Path(temporary) / "list.csv", "a", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows(args.data))
        command = [BENCH / "train_walls", file.name, "--out", args.out]
        if args.leave_out:
            args.leave_out.mkdir(parents=True, exist_ok=True)
            command += ["--leave-out", args.leave_out]
        subprocess.run(command, check=True)


if __name__ == "__main__":
    main()
