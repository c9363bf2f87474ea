#!/usr/bin/python3
"""Buildings that are not as drawn, of drawings with known walls: a folder for bench_buildings.

    bend_drawings.py ../shared/data build/release/madori OUT [--only school_L3=0.04,...] [--amplitude 0.3] [--seed 1]

Of each drawing of DATA/corpus whose truth is whole (faces or lines): its true walls are carried away by a smooth field
(largest displacement AMPLITUDE metres, bends of about 15 m), each wall stands a few centimetres beside that (Student's t of
3, scale 0.03 m), boxes stand about that are not drawn. Routes run over floor that is 0.75 m free on the imported drawing
and in the building: a tree of shortest ways between stations that lie far from each other. Then

    bench_buildings OUT/buildings --laps 1

Needs numpy and scipy (apt: python3-numpy python3-scipy python3-yaml)."""
import argparse
import csv
import heapq
import subprocess
from pathlib import Path

import numpy as np
import yaml
from scipy import ndimage

CELL_M = 0.1      # of the floor that is searched for ways
FREE_M = 0.75     # beside a way, drawn and in truth
BEND_M = 15.0     # length of the field's bends
BESIDE_M = 0.03   # scale of a wall's own error
STATIONS = 5
STARTS = 3
# Metres a pixel that nobody gave, from the width of a door (0.9 m) in the picture.
ASSUMED = {"college_hall9": 0.04, "college_mb1": 0.04, "institute_floor1": 0.03, "campus_floor0": 0.05,
           "campus_floor2": 0.05, "shop_dupont": 0.012}


class Field:
    """A smooth displacement whose largest is `amplitude_m` in a box of `width_m` x `height_m`."""

    def __init__(self, amplitude_m, width_m, height_m, random):
        self.wave = random.normal(0.0, 1.0 / BEND_M, (40, 2))
        self.phase = random.uniform(0.0, 2.0 * np.pi, 40)
        self.share = random.normal(size=(40, 2))
        x, y = np.meshgrid(np.arange(0.0, width_m, 1.0), np.arange(0.0, height_m, 1.0))
        grid = np.c_[x.ravel(), y.ravel()]
        self.scale = amplitude_m / max(1e-9, np.linalg.norm(self.raw(grid), axis=1).max())

    def raw(self, points):
        return np.cos(points @ self.wave.T + self.phase) @ self.share

    def __call__(self, points):
        points = np.asarray(points, float)
        return points + self.scale * self.raw(points.reshape(-1, 2)).reshape(points.shape)


def read_lines(file):
    rows = list(csv.reader(open(file)))
    return np.array([[float(v) for v in row[-4:]] for row in rows[1:] if row]).reshape(-1, 2, 2)


def imported_walls(madori, drawing, m_per_px, site):
    subprocess.run([madori, "import", drawing, "--site", site, "--scale", str(m_per_px)], check=True,
                   stdout=subprocess.DEVNULL)
    rows = list(csv.DictReader(open(Path(site) / "walls.csv")))
    return np.array([[[float(r["x1"]), float(r["y1"])], [float(r["x2"]), float(r["y2"])]] for r in rows])


def in_building(lines, field, random):
    """The walls where they stand, in pieces of at most a metre."""
    stands = []
    for a, b in lines:
        length = np.linalg.norm(b - a)
        if length < 0.05:
            continue
        normal = np.array([-(b - a)[1], (b - a)[0]]) / length
        beside = BESIDE_M * np.clip(random.standard_t(3), -5.0, 5.0) * normal
        steps = np.linspace(0.0, 1.0, int(np.ceil(length)) + 1)[:, None]
        points = field(a * (1.0 - steps) + b * steps) + beside
        stands += list(zip(points[:-1], points[1:]))
    return stands


def free_m(lines, width_m, height_m):
    """Distance to the next line, at each cell of the floor."""
    size = (int(height_m / CELL_M) + 1, int(width_m / CELL_M) + 1)
    floor = np.ones(size, bool)
    for a, b in lines:
        steps = np.linspace(0.0, 1.0, int(2.0 * np.linalg.norm(b - a) / CELL_M) + 2)[:, None]
        cells = np.round((a * (1.0 - steps) + b * steps)[:, ::-1] / CELL_M).astype(int)
        floor[tuple(np.clip(cells, 0, np.array(size) - 1).T)] = False
    return ndimage.distance_transform_edt(floor) * CELL_M


def far_apart(cells, count, random):
    chosen = [cells[random.integers(len(cells))]]
    while len(chosen) < count:
        least = np.min([np.linalg.norm(cells - c, axis=1) for c in chosen], axis=0)
        far = np.flatnonzero(least > 0.5 * least.max())
        chosen.append(cells[random.choice(far)])
    return [tuple(c) for c in chosen]


def tree_of_ways(free, room_m, stations):
    """Predecessors of the shortest ways from the first station, which keep to the middle."""
    best, before = {stations[0]: 0.0}, {}
    queue = [(0.0, stations[0])]
    while queue:
        cost, at = heapq.heappop(queue)
        if cost > best[at]:
            continue
        for dy, dx in ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)):
            to = (at[0] + dy, at[1] + dx)
            if not (0 <= to[0] < free.shape[0] and 0 <= to[1] < free.shape[1] and free[to]):
                continue
            paid = cost + np.hypot(dy, dx) * (1.0 + 1.0 / room_m[to])
            if paid < best.get(to, np.inf):
                best[to], before[to] = paid, at
                heapq.heappush(queue, (paid, to))
    return before


def is_clear(free, a, b):
    count = 2 * int(max(abs(a[0] - b[0]), abs(a[1] - b[1]))) + 1
    return all(free[tuple(np.round(np.array(a) + (np.array(b) - a) * t).astype(int))]
               for t in np.linspace(0.0, 1.0, count))


def routes(free, room_m, stations):
    """Nodes (cells, stations first) and edges of the tree, in long straight legs."""
    before = tree_of_ways(free, room_m, stations)
    children = {}
    for station in stations:
        at = station
        while at in before:
            children.setdefault(before[at], set()).add(at)
            at = before[at]
    kept = set(stations) | {c for c, n in children.items() if len(n) > 1}
    nodes, edges = list(stations), []
    index = {c: i for i, c in enumerate(nodes)}

    def number(cell):
        if cell not in index:
            index[cell] = len(nodes)
            nodes.append(cell)
        return index[cell]

    for end in sorted(kept - {stations[0]}):
        way = [end]
        while way[-1] in before and (len(way) == 1 or way[-1] not in kept):
            way.append(before[way[-1]])
        i = 0
        while i < len(way) - 1:
            j = len(way) - 1
            while j > i + 1 and not is_clear(free, way[i], way[j]):
                j -= 1
            edges.append((number(way[i]), number(way[j])))
            i = j
    return nodes, edges


def write_routes(folder, nodes, edges):
    folder.mkdir()
    with open(folder / "path.csv", "w") as out:
        out.write("ID,x,y,station\n")
        for i, (v, u) in enumerate(nodes):
            out.write(f"{i},{u * CELL_M:.2f},{v * CELL_M:.2f},{int(i < STATIONS)}\n")
    near = {i: sorted({b for a, b in edges if a == i} | {a for a, b in edges if b == i}) for i in range(len(nodes))}
    with open(folder / "tree.csv", "w") as out:
        out.write("ID,EDA\n")
        for i, to in near.items():
            out.write(f"{i},{' '.join(map(str, to))}\n")


def boxes_on(floor, count, random):
    """Boxes on floor (cells) that no way needs: middle, yaw, length, width."""
    cells = np.argwhere(floor)
    chosen = cells[random.choice(len(cells), min(count, len(cells)), replace=False)] if len(cells) else []
    return [(np.array([u, v]) * CELL_M, random.uniform(0.0, 180.0), random.uniform(0.2, 0.8),
             random.uniform(0.1, 0.5)) for v, u in chosen]


def heading_deg(room_m, place, random):
    """A heading with room for the vehicle, whose nose is 0.8 m ahead and 0.7 m wide."""
    while True:
        heading = random.uniform(-np.pi, np.pi)
        nose = place + 0.6 * np.array([np.cos(heading), np.sin(heading)])
        if room_m[tuple(np.round(nose[::-1] / CELL_M).astype(int))] > 0.55:
            return np.degrees(heading)


def write_start(file, seed, name, place, yaw_deg, boxes):
    with open(file, "w") as out:
        out.write(f"madori_scenario: 1\nname: {name}\nseed: {seed}\n"
                  f"start: {{x_m: {place[0]:.3f}, y_m: {place[1]:.3f}, yaw_deg: {yaw_deg:.0f}}}\n"
                  "building: {walls: true.csv, wall_height_m: 2.6, ceiling_height_m: 2.6}\n"
                  "vlp16: {keep_every_firing: 3}\n" + ("solids:\n" if boxes else ""))
        for middle, yaw, length, width in boxes:
            out.write(f"  - {{kind: clutter, centre: [{middle[0]:.3f}, {middle[1]:.3f}], yaw_deg: {yaw:.1f}, "
                      f"length_m: {length:.2f}, width_m: {width:.2f}, height_m: 1.2}}\n")


def building(data, madori, out, name, m_per_px, amplitude_m, seed):
    random = np.random.default_rng([seed, *name.encode()])
    source = data / "corpus" / name
    meta = yaml.safe_load(open(source / "meta.yaml"))
    width_m, height_m = meta["width"] * m_per_px, meta["height"] * m_per_px
    lines = read_lines(source / "walls.csv") * [m_per_px, -m_per_px] + [0.0, height_m]
    drawing = source / meta["drawing"]
    drawn = imported_walls(madori, drawing, m_per_px, out / "sites" / name)
    field = Field(amplitude_m, width_m, height_m, random)
    room_m = free_m(list(drawn) + list(lines), width_m, height_m)
    free = room_m > FREE_M
    labels, _ = ndimage.label(free)
    corner_labels = {labels[0, 0], labels[0, -1], labels[-1, 0], labels[-1, -1]}
    sizes = np.bincount(labels.ravel())
    sizes[[0, *corner_labels]] = 0  # outside is no floor
    free = labels == sizes.argmax()
    stations = far_apart(np.argwhere(free), STATIONS, random)
    nodes, edges = routes(free, room_m, stations)
    folder = out / "buildings" / name
    folder.mkdir()
    write_routes(folder / "routes", nodes, edges)
    ways = free_m([np.array([nodes[a][::-1], nodes[b][::-1]]) * CELL_M for a, b in edges], width_m, height_m)
    boxes = boxes_on(free & (ways > FREE_M + 0.6), int(random.integers(12, 21)), random)
    boxes = [(field(middle), *shape) for middle, *shape in boxes]
    with open(folder / "true.csv", "w") as file:
        file.write("id,x1,y1,x2,y2\n")
        for i, (a, b) in enumerate(in_building(lines, field, random)):
            file.write(f"{i},{a[0]:.4f},{a[1]:.4f},{b[0]:.4f},{b[1]:.4f}\n")
    for start in range(STARTS):
        cell = nodes[int(random.integers(len(nodes)))]
        place = np.array([cell[1], cell[0]]) * CELL_M
        write_start(folder / f"start{start}.yaml", start + 1, name, field(place), heading_deg(room_m, place, random),
                    boxes)
    file = drawing.relative_to(data)
    return f"| {name} | {file}, {m_per_px} m/px | bent by at most {amplitude_m} m, seed {seed} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("madori")
    parser.add_argument("out", type=Path, help="a folder that is not there yet")
    parser.add_argument("--only", default="", help="names, comma between, each with =METRES_PER_PIXEL where not known")
    parser.add_argument("--amplitude", type=float, default=0.3)
    parser.add_argument("--seed", type=int, default=1)
    a = parser.parse_args()
    a.out.mkdir(parents=True)
    (a.out / "buildings").mkdir()
    (a.out / "sites").mkdir()
    (a.out / "corpus").symlink_to((a.data / "corpus").resolve())
    wanted = dict((part.split("=") + [""])[:2] for part in a.only.split(",") if part)
    rows = []
    for row in csv.DictReader(open(a.data / "corpus" / "index.csv")):
        name = row["name"]
        scale = wanted.get(name) or row["m_per_px"] or ASSUMED.get(name, "")
        if row["truth"] == "contours" or not scale or (wanted and name not in wanted):
            continue
        rows.append(building(a.data, a.madori, a.out, name, float(scale), a.amplitude, a.seed))
        print(rows[-1], flush=True)
    (a.out / "buildings" / "README.md").write_text(
        "| folder | drawing and scale | truth |\n| --- | --- | --- |\n" + "\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
