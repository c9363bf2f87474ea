#!/usr/bin/python3
"""Trains the wall model of the drawing import, by one command.

  cmake --build build/release --target draughtsman measure_sheets train_walls && tests/bench/train_walls.py [--leave-out FOLDER]

Writes data/wall_model/wall_model.ubj from the real drawings of ../shared/data/corpus, the older ones with truth, and the
plans of the draughtsman (seeds 1 to --plans). With --leave-out also one model for every group of sources of the corpus that
saw none of their drawings, FOLDER/GROUP.ubj: tests/bench/leave_one_source_out.py scores those. Drawings are measured once and
kept in --sheets: delete that folder where the features or the draughtsman have changed. The same data give the same bytes.
Build again afterwards: the model is compiled in."""
import argparse
import concurrent.futures
import csv
import pathlib
import subprocess
import sys

import yaml
from PIL import Image

Image.MAX_IMAGE_PIXELS = None
ROOT = pathlib.Path(__file__).resolve().parents[2]
BENCH = ROOT / "build/release/tests/bench"
# The older drawings, which the shipped model must know: metres a pixel, how near its truth a line is a wall (they are
# scored with 0.15 m; the truth of the hotel lies beside its walls by about that), weight beside a drawing of the corpus.
HOME = {"office": (0.00846, 0.1, 10), "clinic": (0.02692, 0.1, 10), "hotel_L1": (0.05568, 0.15, 5),
        "mlstruct_7db30954": (0.00474825, 0.1, 10), "mlstruct_8888a588": (0.00272847, 0.1, 10)}
# Plans of the draughtsman of one kind: option, how many, first seed.
KINDS = {"sketches": (120, 10001), "factories": (120, 20001)}
COARSER = 0.7  # of the size that the import reduces a drawing to, or of its own
SHEET_PX = 7e6
GROUPS = 5  # models that leave sources out: each leaves out every fifth source at least


def source_of(meta):
    return meta["repository"].replace("/", "_")


def metas(data):
    return [(file, yaml.safe_load(file.read_text(encoding="utf-8"))) for file in sorted(data.glob("corpus/*/meta.yaml"))]


def groups(data):
    """Sources that are left out together: the two largest by themselves, the others by turns."""
    count = {}
    for _, meta in metas(data):
        count[source_of(meta)] = count.get(source_of(meta), 0) + 1
    order = sorted(count, key=lambda source: (-count[source], source))
    return [order[:1], order[1:2]] + [order[2 + k::GROUPS - 2] for k in range(GROUPS - 2)]


def rows(data):
    for file, meta in metas(data):
        boxes = " ".join(str(value) for box in meta.get("ignore") or [] for value in box)
        yield (meta["name"], source_of(meta), 1, file.parent / meta["drawing"], file.parent / "walls.csv",
               meta["tolerance_px"], meta["truth"], boxes)
    for name, (scale, tolerance, weight) in HOME.items():
        folder = data / "drawings" / name
        yield name, "home", weight, folder / f"{name}.png", folder / "walls.csv", tolerance / scale, "faces", ""
    factory = ROOT / "data/sample_factory"
    yield "sample_factory", "home", 10, factory / "factory_scan.png", factory / "true_walls_scan_px.csv", 4, "faces", ""


def coarser(row, folder):
    """The same drawing as a coarser scan has it, with half the weight: what is a wall does not hang on the resolution."""
    name, source, weight, drawing, walls, tolerance, truth, boxes = row
    drawn = Image.open(drawing).convert("RGBA")
    picture = Image.new("RGBA", drawn.size, "white")
    picture.alpha_composite(drawn)
    picture = picture.convert("RGB")
    scale = COARSER * min(1, (SHEET_PX / (picture.width * picture.height)) ** 0.5)
    out = folder / f"{name}_coarser.png"
    picture.resize((round(scale * picture.width), round(scale * picture.height)), Image.Resampling.BOX).save(out)
    with open(walls, encoding="utf-8") as file:
        lines = [",".join(str(scale * float(line[key])) for key in ("u1", "v1", "u2", "v2")) for line in csv.DictReader(file)]
    out.with_suffix(".csv").write_text("\n".join(["u1,v1,u2,v2", *lines, ""]), encoding="utf-8")
    return (f"{name}_coarser", source, weight / 2, out, out.with_suffix(".csv"), scale * tolerance, truth,
            " ".join(str(scale * float(value)) for value in boxes.split()))


def measure(args):
    args.sheets.mkdir(parents=True, exist_ok=True)
    plans = args.sheets / "plans"
    if not (plans / "list.csv").exists():
        subprocess.run([BENCH / "draughtsman", plans, "--plans", str(args.plans)], check=True)
    for kind, (count, seed) in KINDS.items():
        if not (plans / kind / "list.csv").exists():
            subprocess.run([BENCH / "draughtsman", plans / kind, "--plans", str(count), "--first-seed", str(seed), f"--{kind}"],
                           check=True)
    with open(args.sheets / "real.csv", "w", encoding="utf-8", newline="") as file:
        file.write("name,source,weight,drawing,walls,tolerance_px,truth,ignore\n")
        real = list(rows(args.data))
        csv.writer(file, lineterminator="\n").writerows([*real, *(coarser(row, plans) for row in real)])
    tables = [args.sheets / "real.csv", plans / "list.csv", *(plans / kind / "list.csv" for kind in KINDS)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda table: subprocess.run([BENCH / "measure_sheets", table, args.sheets], check=True,
                                                   stdout=subprocess.DEVNULL), tables))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plans", type=int, default=400, help="of the draughtsman, default %(default)s")
    parser.add_argument("--leave-out", type=pathlib.Path, help="folder for the models that miss some sources each")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "data/wall_model/wall_model.ubj")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data", help="default ../shared/data")
    parser.add_argument("--sheets", type=pathlib.Path, default=ROOT / "build/wall_sheets", help="default build/wall_sheets")
    args = parser.parse_args()
    if not (args.data / "corpus").exists():
        sys.exit(f"train_walls.py: {args.data / 'corpus'} is not there")
    measure(args)
    models = [["--out", args.out]]
    if args.leave_out:
        args.leave_out.mkdir(parents=True, exist_ok=True)
        models += [["--out", args.leave_out / f"{number}.ubj", "--without", ",".join(group)]
                   for number, group in enumerate(groups(args.data))]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:  # each trains on one core
        list(pool.map(lambda model: subprocess.run([BENCH / "train_walls", args.sheets, *model], check=True), models))


if __name__ == "__main__":
    main()
