#!/usr/bin/python3
"""Draws the sample factory of factory.yaml: DXF, PDF and a "scanned" PNG, with the true walls and the routes beside them.

  draw.py --out FOLDER

Files: factory.dxf (millimetres), factory.pdf, factory_scan.png; for the DXF in metres and for the scan in pixels the
true walls; routes in the Map frame of each import; meta.yaml with scales and transforms. The same drawing each time."""
import argparse
import csv
import math
import os
import pathlib
import sys

import yaml

import geometry
import sheet as sheets
import writers

DPI = 127.0       # 0.2 mm a pixel
SKEW_DEG = 1.3
SEED = 20240314


def frame_of(spec):
    width, height = spec["width_mm"] * spec["scale"] / 1000, spec["height_mm"] * spec["scale"] / 1000
    return (-spec["left_m"], -spec["bottom_m"], width - spec["left_m"], height - spec["bottom_m"])


def scan_map_from_factory(frame, size_px, m_per_px):
    """Factory metres -> Map metres of the scan (PIL turns counter-clockwise about the middle of the picture)."""
    a = math.radians(SKEW_DEG)
    middle = (size_px[0] * m_per_px / 2, size_px[1] * m_per_px / 2)
    def move(p):
        x, y = p[0] - frame[0] - middle[0], p[1] - frame[1] - middle[1] - (size_px[1] * m_per_px - (frame[3] - frame[1]))
        return (middle[0] + math.cos(a) * x - math.sin(a) * y, middle[1] + math.sin(a) * x + math.cos(a) * y)
    return move


def write_csv(path, header, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def write_routes(folder, factory, move, turn_deg):
    folder.mkdir(parents=True, exist_ok=True)
    neighbours = {node[0]: [] for node in factory["nodes"]}
    for a, b in factory["legs"]:
        neighbours[a].append(b)
        neighbours[b].append(a)
    write_csv(folder / "tree.csv", ["ID", "EDA"], [[i, " ".join(map(str, sorted(n)))] for i, n in neighbours.items()])
    rows = []
    for i, x, y, name, station, heading, action in factory["nodes"]:
        u, v = move((x, y))
        rows.append([i, f"{u:.3f}", f"{v:.3f}", name, station, "" if heading == "" else f"{heading + turn_deg:g}", "", action])
    write_csv(folder / "path.csv", ["ID", "x", "y", "name", "station", "heading_deg", "speed_mps", "action"], rows)


def fix_hash_seed():
    """ezdxf writes some sections in the order of Python's hashes: start again with fixed ones."""
    if os.environ.get("PYTHONHASHSEED") != "0":
        os.execve(sys.executable, [sys.executable, "-B", *sys.argv], {**os.environ, "PYTHONHASHSEED": "0"})


def main():
    fix_hash_seed()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).parent, help="folder for the files")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    factory = yaml.safe_load((pathlib.Path(__file__).parent / "factory.yaml").read_text(encoding="utf-8"))
    spec = factory["sheet"]
    frame = frame_of(spec)
    m_per_px = round(25.4 / DPI * spec["scale"] / 1000, 9)
    size_px = (round((frame[2] - frame[0]) / m_per_px), round((frame[3] - frame[1]) / m_per_px))

    sheet = sheets.compose(factory, frame)
    writers.write_dxf(sheet, out / "factory.dxf")
    writers.write_pdf(sheet, out / "factory.pdf", frame, (spec["width_mm"], spec["height_mm"]), spec["scale"])
    clean = writers.draw_raster(sheet, frame, size_px, m_per_px, spec["scale"])
    writers.scan(clean, SKEW_DEG, SEED).save(out / "factory_scan.png", optimize=True, dpi=(DPI, DPI))

    faces = geometry.wall_faces(factory)
    move = scan_map_from_factory(frame, size_px, m_per_px)
    pixel = lambda p: (move(p)[0] / m_per_px, size_px[1] - move(p)[1] / m_per_px)
    write_csv(out / "true_walls.csv", ["id", "x1", "y1", "x2", "y2"],
              [[i, *(f"{c:.4f}" for p in face for c in p)] for i, face in enumerate(faces, 1)])
    write_csv(out / "true_walls_scan_px.csv", ["u1", "v1", "u2", "v2"],
              [[f"{c:.2f}" for p in face for c in pixel(p)] for face in faces])
    write_routes(out / "routes_factory", factory, lambda p: p, 0.0)
    write_routes(out / "routes_scan", factory, move, SKEW_DEG)
    origin = move((0, 0))
    known = [round(c, 2) for x in (0.0, factory["size"][0]) for c in pixel((x, sheets.TOTAL_LENGTH_Y))]
    meta = {"scan": {"file": "factory_scan.png", "m_per_px": m_per_px, "skew_deg": SKEW_DEG,
                     "map_from_factory": {"x_m": round(origin[0], 6), "y_m": round(origin[1], 6), "yaw_deg": SKEW_DEG},
                     "known_length": {"pixels": known, "metres": factory["size"][0]}},
            "pdf": {"file": "factory.pdf", "paper_scale": spec["scale"], "map_from_factory": {"x_m": -frame[0], "y_m": -frame[1], "yaw_deg": 0.0}},
            "dxf": {"file": "factory.dxf", "unit_m": 0.001}}
    (out / "meta.yaml").write_text(yaml.safe_dump(meta, sort_keys=False), encoding="utf-8")


if __name__ == "__main__":
    main()
