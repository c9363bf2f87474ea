"""Walls of factory.yaml as faces: middle lines grow to their thickness, join, and openings are cut out."""
import math

from shapely.geometry import LineString, MultiPolygon, box
from shapely.ops import unary_union

ARC_STEP_DEG = 4.0


def arc_points(centre, radius, from_deg, to_deg, step_deg=ARC_STEP_DEG):
    count = max(2, math.ceil(abs(to_deg - from_deg) / step_deg) + 1)
    angles = [math.radians(from_deg + (to_deg - from_deg) * i / (count - 1)) for i in range(count)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def door_opening(door, depth=0.5):
    """The piece that a door takes out of its wall."""
    (x, y), w, a = door["hinge"], door["width"], math.radians(door["along_deg"])
    end = (x + w * math.cos(a), y + w * math.sin(a))
    return LineString([(x, y), end]).buffer(depth / 2, cap_style=2)


def thick(line, thickness):
    closed = tuple(line[0]) == tuple(line[-1])
    shape = LineString(line).buffer(thickness / 2, cap_style=2, join_style=2)
    return unary_union([shape, LineString([line[-2], line[-1], line[1]]).buffer(thickness / 2, cap_style=2, join_style=2)]) if closed else shape


def solids(factory):
    """kind -> the area that its walls cover, openings cut out."""
    parts = {"hatched": [], "double": []}
    for wall in factory["walls"]:
        parts[wall["kind"]].append(thick(wall["line"], wall["thickness"]))
    for arc in factory["arcs"]:
        line = arc_points(arc["centre"], arc["radius"], arc["from_deg"], arc["to_deg"])
        parts[arc["kind"]].append(LineString(line).buffer(arc["thickness"] / 2, cap_style=2, join_style=2))
    cut = unary_union([box(*o) for o in factory["openings"]] + [door_opening(d) for d in factory["doors"]])
    hatched = unary_union(parts["hatched"]).difference(cut)
    return {"hatched": hatched, "double": unary_union(parts["double"]).difference(cut).difference(hatched)}


def rings(area):
    for polygon in area.geoms if isinstance(area, MultiPolygon) else [area]:
        yield list(polygon.exterior.coords)
        for hole in polygon.interiors:
            yield list(hole.coords)


def columns(factory):
    half = factory["columns"]["size"] / 2
    return unary_union([box(x - half, y - half, x + half, y + half) for x, y in factory["columns"]["at"]])


def wall_faces(factory):
    """Every straight face of walls and columns as ((x1, y1), (x2, y2)): what a lidar can see and a drawing shows."""
    faces = []
    everything = unary_union([*solids(factory).values(), columns(factory)])
    for ring in rings(everything):
        faces += [(a, b) for a, b in zip(ring[:-1], ring[1:]) if math.dist(a, b) > 1e-6]
    return faces


def hatch_lines(area, spacing, angle_deg=45.0):
    """Parallel lines across an area."""
    low_x, low_y, high_x, high_y = area.bounds
    reach = math.hypot(high_x - low_x, high_y - low_y)
    middle = ((low_x + high_x) / 2, (low_y + high_y) / 2)
    a = math.radians(angle_deg)
    along, across = (math.cos(a), math.sin(a)), (-math.sin(a), math.cos(a))
    strokes = []
    for i in range(-int(reach / spacing), int(reach / spacing) + 1):
        p = (middle[0] + across[0] * i * spacing, middle[1] + across[1] * i * spacing)
        line = LineString([(p[0] - along[0] * reach, p[1] - along[1] * reach), (p[0] + along[0] * reach, p[1] + along[1] * reach)])
        piece = line.intersection(area)
        for part in getattr(piece, "geoms", [piece]):
            if part.length > 0.02:
                strokes.append(tuple(part.coords))
    return strokes
