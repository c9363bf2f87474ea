#!/usr/bin/python3
"""Draws a revision of the sample factory: a wall moved, one removed, a hall added, a door walled up; on a sheet of another
scale and place. Usage: revised_factory.py SAMPLE_FACTORY OUT; OUT gets the drawings, and changes.json with the faces that
are gone and new, in the Map of the imported scan, metres."""
import json
import math
import pathlib
import shutil
import subprocess
import sys

import yaml

MOVED = ([[12.0, 38.12], [12.0, 43.6]], [[13.5, 38.12], [13.5, 43.6]])
REMOVED = [[20.5, 38.12], [20.5, 43.6]]
HALL = {"kind": "hatched", "thickness": 0.24, "line": [[48.0, 49.85], [48.0, 55.0], [60.0, 55.0], [60.0, 49.85]]}
WALLED_UP = [64.0, 37.9, 67.0, 38.1]  # the only way to the batteries
SHEET = {"width_mm": 1189, "height_mm": 841, "scale": 100, "left_m": 20.0, "bottom_m": 14.0}
SAME_M = 0.02


def revised(factory):
    walls = [w for w in factory["walls"] if w["line"] != REMOVED]
    assert len(walls) == len(factory["walls"]) - 1 and any(w["line"] == MOVED[0] for w in walls)
    walls = [{**w, "line": MOVED[1]} if w["line"] == MOVED[0] else w for w in walls]
    openings = [o for o in factory["openings"] if o != WALLED_UP]
    assert len(openings) == len(factory["openings"]) - 1
    return {**factory, "walls": [*walls, HALL], "openings": openings, "sheet": SHEET}


def pieces_without(faces, others, step=0.05):
    """Pieces of the faces along which no other face runs, longer than a metre."""
    from shapely.geometry import LineString
    from shapely.ops import unary_union
    beside = unary_union([LineString(o).buffer(SAME_M, cap_style=2) for o in others])
    left = []
    for face in faces:
        rest = LineString(face).difference(beside)
        for piece in getattr(rest, "geoms", [rest]):
            if piece.length > 1.0:
                left.append([*piece.coords[0], *piece.coords[-1]])
    return left


def main():
    sample, out = map(pathlib.Path, sys.argv[1:])
    tools = out / "tools"
    shutil.copytree(sample, tools)
    factory = yaml.safe_load((sample / "factory.yaml").read_text(encoding="utf-8"))
    now = revised(factory)
    (tools / "factory.yaml").write_text(yaml.safe_dump(now), encoding="utf-8")
    subprocess.run([sys.executable, "-B", tools / "draw.py", "--out", out / "drawn"], check=True)
    sys.path.insert(0, str(tools))
    import geometry
    before, after = geometry.wall_faces(factory), geometry.wall_faces(now)
    frame = yaml.safe_load((sample / "meta.yaml").read_text())["scan"]["map_from_factory"]
    c, s = math.cos(math.radians(frame["yaw_deg"])), math.sin(math.radians(frame["yaw_deg"]))

    def move(x, y):
        return c * x - s * y + frame["x_m"], s * x + c * y + frame["y_m"]

    rows = {name: [[round(v, 4) for end in (p[:2], p[2:]) for v in move(*end)] for p in pieces]
            for name, pieces in (("gone", pieces_without(before, after)), ("added", pieces_without(after, before)))}
    (out / "changes.json").write_text(json.dumps(rows), encoding="utf-8")


main()
