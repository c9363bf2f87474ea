#!/usr/bin/python3
"""A real building beside its drawing: the shared office, as a lidar mapped it. A folder for bench_buildings.

    scanned_office.py ../shared/data OUT [--size 1.0] [--free 0.75] [--seed 1]

The cells that the lidar found occupied are laid on the drawing (drawings/office) by its source's turn and the shift that fits
best, and outlined: pieces of 0.6 m and more are true walls, shorter ones stand as clutter. Routes as bend_drawings.py lays
them, over floor that is FREE metres free on the drawing and in the building. SIZE 0.98: the building is 2 % smaller than drawn. Then

    bench_buildings OUT/buildings --laps 2

Needs numpy, scipy, OpenCV (apt: python3-numpy python3-scipy python3-yaml python3-opencv)."""
import argparse
from pathlib import Path

import cv2
import numpy as np
from scipy import ndimage

import bend_drawings as bend

SCAN_M = 0.0506424                      # a cell of the scan
TURN_RAD = -1.20344                     # scan to drawing, as the source states it
SHIFT_M = np.array([21.531, 4.517])     # likewise: a first guess
WALL_M = 0.6
# Dimension lines of the drawing: pixels from, to, metres.
MEASURED = [((258.73, 1426.88), (2624.46, 1625.22), 20.089), ((580.79, 43.40), (80.27, 1024.97), 9.315),
            ((2951.32, 368.57), (2809.31, 1349.93), 8.409)]


def metres_a_pixel():
    return float(np.mean([m / np.linalg.norm(np.subtract(a, b)) for a, b, m in MEASURED]))


class Laid:
    """Cells of the scan (u, v) on the drawing's Map frame, whose drawn walls (metres) they lie on as well as they can."""

    def __init__(self, cells, drawn, width_m, height_m, size):
        self.turn = np.array([[np.cos(TURN_RAD), -np.sin(TURN_RAD)], [np.sin(TURN_RAD), np.cos(TURN_RAD)]]) * size
        self.shift = SHIFT_M + [0.0, height_m]
        off_m = bend.free_m(drawn, width_m, height_m)

        def fit(shift):
            at = np.round((cells * [SCAN_M, -SCAN_M] @ self.turn.T + shift)[:, ::-1] / bend.CELL_M).astype(int)
            at = np.clip(at, 0, np.array(off_m.shape) - 1)
            return np.exp(-0.5 * (off_m[at[:, 0], at[:, 1]] / 0.15) ** 2).mean()

        step_m = 0.2
        while step_m > 0.01:
            around = [self.shift + step_m * np.array(d) for d in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))]
            best = max(range(5), key=lambda i: fit(around[i]))
            self.shift, step_m = around[best], step_m if best else step_m / 2.0

    def __call__(self, cells):
        return np.asarray(cells, float) * [SCAN_M, -SCAN_M] @ self.turn.T + self.shift


def outlines(occupied, laid):
    """Walls and clutter: pairs of points, metres."""
    walls, clutter = [], []
    for outline in cv2.findContours(occupied.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]:
        corners = laid(cv2.approxPolyDP(outline, 1.2, True)[:, 0, :])
        for a, b in zip(corners, np.roll(corners, -1, 0)):
            length = np.linalg.norm(b - a)
            if length > 2.0 * SCAN_M:
                (walls if length >= WALL_M else clutter).append((a, b))
    return walls, clutter


def as_box(a, b):
    yaw = np.degrees(np.arctan2(*(b - a)[::-1]))
    return (a + b) / 2.0, yaw, max(0.08, np.linalg.norm(b - a)), 0.08


def seen_floor(scan, laid, shape):
    """Where the lidar found the floor free, in cells of the routes' grid."""
    v, u = np.nonzero(scan > 240)
    at = np.round(laid(np.c_[u, v])[:, ::-1] / bend.CELL_M).astype(int)
    at = at[(at >= 0).all(1) & (at < shape).all(1)]
    floor = np.zeros(shape, bool)
    floor[tuple(at.T)] = True
    return ndimage.binary_closing(floor, iterations=2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("out", type=Path, help="a folder that is not there yet")
    parser.add_argument("--size", type=float, default=1.0)
    parser.add_argument("--free", type=float, default=bend.FREE_M)
    parser.add_argument("--seed", type=int, default=1)
    a = parser.parse_args()
    source, m_per_px, random = a.data / "drawings/office", metres_a_pixel(), np.random.default_rng(a.seed)
    height_px, width_px = cv2.imread(str(source / "office.png"), cv2.IMREAD_GRAYSCALE).shape
    width_m, height_m = width_px * m_per_px, height_px * m_per_px
    drawn = list(bend.read_lines(source / "walls.csv") * [m_per_px, -m_per_px] + [0.0, height_m])
    scan = cv2.imread(str(source / "office_scan.png"), cv2.IMREAD_GRAYSCALE)
    v, u = np.nonzero(scan < 50)
    laid = Laid(np.c_[u, v], drawn, width_m, height_m, a.size)
    walls, clutter = outlines(scan < 50, laid)
    room_m = bend.free_m(drawn + walls + clutter, width_m, height_m)
    labels, _ = ndimage.label((room_m > a.free) & seen_floor(scan, laid, room_m.shape))
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    free = labels == sizes.argmax()
    nodes, edges = bend.routes(free, room_m, bend.far_apart(np.argwhere(free), bend.STATIONS, random))
    folder = a.out / "buildings/office"
    folder.mkdir(parents=True)
    (a.out / "drawings").symlink_to((a.data / "drawings").resolve())
    bend.write_routes(folder / "routes", nodes, edges)
    with open(folder / "true.csv", "w") as file:
        file.write("id,x1,y1,x2,y2\n")
        for i, (p, q) in enumerate(walls):
            file.write(f"{i},{p[0]:.4f},{p[1]:.4f},{q[0]:.4f},{q[1]:.4f}\n")
    for start in range(4):
        place = np.array(nodes[int(random.integers(len(nodes)))])[::-1] * bend.CELL_M
        bend.write_start(folder / f"start{start}.yaml", start + 1, "office", place, bend.heading_deg(room_m, place, random),
                         [as_box(p, q) for p, q in clutter])
    (a.out / "buildings/README.md").write_text(
        f"| folder | drawing and scale | truth |\n| --- | --- | --- |\n| office | drawings/office, {m_per_px:.6f} m/px | a lidar's map |\n")


if __name__ == "__main__":
    main()
