"""What is drawn, independent of the file format: strokes, arcs and texts on named layers, in metres."""
import math
from dataclasses import dataclass, field

import geometry

# layer -> (pen in mm on paper, linetype)
LAYERS = {
    "WALLS": (0.35, None), "WALLS_HATCH": (0.13, None), "COLUMNS": (0.35, None), "DOORS": (0.18, None),
    "MACHINES": (0.18, None), "SHELVES": (0.18, None), "FURNITURE": (0.13, None), "CRANE": (0.25, (3.0, 1.5)),
    "LANES": (0.18, (1.5, 1.0)), "AXES": (0.13, (6.0, 1.0, 0.6, 1.0)), "AXES_BUBBLES": (0.18, None),
    "DIMENSIONS": (0.13, None), "TEXT": (0.18, None), "TITLE": (0.35, None),
}


TOTAL_LENGTH_Y = -5.6  # of the dimension line that states the length of the factory


@dataclass
class Sheet:
    strokes: list = field(default_factory=list)  # layer, [(x, y), ...]
    circles: list = field(default_factory=list)  # layer, centre, radius, from_deg, to_deg
    texts: list = field(default_factory=list)    # layer, (x, y) lower left, height, angle_deg, text

    def stroke(self, layer, *points):
        self.strokes.append((layer, [tuple(map(float, p)) for p in points]))

    def rectangle(self, layer, x, y, width, depth):
        self.stroke(layer, (x, y), (x + width, y), (x + width, y + depth), (x, y + depth), (x, y))

    def arc(self, layer, centre, radius, from_deg=0.0, to_deg=360.0):
        self.circles.append((layer, tuple(centre), radius, from_deg, to_deg))

    def text(self, layer, at, height, text, angle_deg=0.0):
        self.texts.append((layer, tuple(at), height, angle_deg, text))


def draw_walls(sheet, factory):
    for kind, area in geometry.solids(factory).items():
        for ring in geometry.rings(area):
            sheet.stroke("WALLS", *ring)
        if kind == "hatched":
            for line in geometry.hatch_lines(area, 0.25):
                sheet.stroke("WALLS_HATCH", *line)
    for ring in geometry.rings(geometry.columns(factory)):
        sheet.stroke("COLUMNS", *ring)
        (x0, y0), (x1, y1) = ring[0], ring[2]
        sheet.stroke("WALLS_HATCH", (x0, y0), (x1, y1))


def draw_doors(sheet, factory):
    for door in factory["doors"]:
        (x, y), w, swing = door["hinge"], door["width"], door["swing"]
        open_deg = door["along_deg"] + 90 * swing
        a = math.radians(open_deg)
        sheet.stroke("DOORS", (x, y), (x + w * math.cos(a), y + w * math.sin(a)))
        sheet.arc("DOORS", (x, y), w, min(door["along_deg"], open_deg), max(door["along_deg"], open_deg))
    x0, y0, x1, y1 = factory["automatic_door"]["rectangle"]
    sheet.rectangle("DOORS", x0 + 0.08, y0, 0.08, (y1 - y0) / 2)
    sheet.rectangle("DOORS", x0 + 0.08, (y0 + y1) / 2, 0.08, (y1 - y0) / 2)
    sheet.text("TEXT", (x0 - 4.3, y0 - 0.9), 0.35, "AUTOMATIC DOOR")
    x0, y0, x1, y1 = factory["lift_door"]["rectangle"]
    sheet.stroke("DOORS", (x0, (y0 + y1) / 2), (x1, (y0 + y1) / 2))
    sheet.stroke("FURNITURE", (35.3, 45.4), (38.7, 49.4))
    sheet.stroke("FURNITURE", (35.3, 49.4), (38.7, 45.4))


def draw_floor(sheet, factory):
    for x, y, w, d, _, label in factory["machines"]:
        sheet.rectangle("MACHINES", x, y, w, d)
        sheet.rectangle("MACHINES", x + 0.15 * w, y + 0.2 * d, 0.45 * w, 0.6 * d)
        sheet.arc("MACHINES", (x + 0.8 * w, y + 0.5 * d), 0.14 * min(w, d))
        sheet.text("TEXT", (x + 0.15, y + d + 0.15), 0.4, label)
    for x, y, w, d, _ in factory["shelves"]:
        sheet.rectangle("SHELVES", x, y, w, d)
        bays = max(1, round(d / 2.0))
        for i in range(bays):
            low, high = y + d * i / bays, y + d * (i + 1) / bays
            sheet.stroke("SHELVES", (x, high), (x + w, high))
            sheet.stroke("SHELVES", (x, low), (x + w, high))
    for x, y, w, d in factory["furniture"]:
        sheet.rectangle("FURNITURE", x, y, w, d)
        sheet.arc("FURNITURE", (x + w / 2, y - 0.35), 0.25)
    for line in factory["crane_lines"]:
        sheet.stroke("CRANE", *line)
    sheet.text("TEXT", (39.0, 17.8), 0.4, "CRANE 5 t")
    for line in factory["lane_lines"]:
        sheet.stroke("LANES", *line)
    for label, x, y, height in factory["rooms"]:
        sheet.text("TEXT", (x, y), height, label)


def draw_axes(sheet, factory):
    width, depth = factory["size"]
    for number, x in enumerate(factory["axes"]["x"], 1):
        sheet.stroke("AXES", (x, -2.0), (x, depth + 4.0))
        sheet.arc("AXES_BUBBLES", (x, depth + 4.8), 0.8)
        sheet.text("TEXT", (x - 0.22, depth + 4.5), 0.6, str(number))
    for letter, y in zip("ABCDEFG", factory["axes"]["y"]):
        sheet.stroke("AXES", (-4.0, y), (width + 2.0, y))
        sheet.arc("AXES_BUBBLES", (-4.8, y), 0.8)
        sheet.text("TEXT", (-5.05, y - 0.3), 0.6, letter)


def dimension(sheet, a, b, text):
    """A dimension line with ticks, extension lines and its figure in millimetres."""
    angle = math.atan2(b[1] - a[1], b[0] - a[0])
    c, s = math.cos(angle), math.sin(angle)
    sheet.stroke("DIMENSIONS", (a[0] - 0.5 * c, a[1] - 0.5 * s), (b[0] + 0.5 * c, b[1] + 0.5 * s))
    for x, y in (a, b):
        sheet.stroke("DIMENSIONS", (x - 0.3 * (c - s), y - 0.3 * (s + c)), (x + 0.3 * (c - s), y + 0.3 * (s + c)))
        sheet.stroke("DIMENSIONS", (x - 0.4 * -s, y - 0.4 * c), (x + 1.6 * -s, y + 1.6 * c))
    middle = ((a[0] + b[0]) / 2 - 1.0 * c + 0.25 * -s, (a[1] + b[1]) / 2 - 1.0 * s + 0.25 * c)
    sheet.text("DIMENSIONS", middle, 0.55, text, math.degrees(angle))


def draw_dimensions(sheet, factory):
    xs, (width, depth) = factory["axes"]["x"], factory["size"]
    for a, b in zip(xs[:-1], xs[1:]):
        dimension(sheet, (a, -3.2), (b, -3.2), str(round(1000 * (b - a))))
    dimension(sheet, (0, TOTAL_LENGTH_Y), (width, TOTAL_LENGTH_Y), str(round(1000 * width)))
    ys = factory["axes"]["y"]
    for a, b in zip(ys[:-1], ys[1:]):
        dimension(sheet, (width + 4.6, a), (width + 4.6, b), str(round(1000 * (b - a))))
    dimension(sheet, (width + 7.0, 0), (width + 7.0, depth), str(round(1000 * depth)))
    sheet.stroke("DIMENSIONS", (27.0, 24.0), (29.0, 26.0), (32.0, 26.0))
    sheet.text("DIMENSIONS", (29.2, 26.15), 0.4, "PREFABRICATED")


def draw_title(sheet, factory, frame):
    x0, y0, x1, y1 = frame
    sheet.rectangle("TITLE", x0 + 0.8, y0 + 0.8, x1 - x0 - 1.6, y1 - y0 - 1.6)
    left, low = x1 - 25.0, y0 + 0.8
    sheet.rectangle("TITLE", left, low, 24.2, 4.8)
    for y in (low + 1.6, low + 3.2):
        sheet.stroke("TITLE", (left, y), (left + 24.2, y))
    sheet.stroke("TITLE", (left + 14.0, low), (left + 14.0, low + 3.2))
    sheet.text("TITLE", (left + 0.5, low + 3.6), 0.8, factory["name"].upper())
    sheet.text("TITLE", (left + 0.5, low + 2.1), 0.55, "GROUND FLOOR LAYOUT")
    sheet.text("TITLE", (left + 14.4, low + 2.1), 0.55, f"SCALE 1:{factory['sheet']['scale']}")
    sheet.text("TITLE", (left + 0.5, low + 0.5), 0.55, "DRAWN K. MADORI  2024-03-14")
    sheet.text("TITLE", (left + 14.4, low + 0.5), 0.55, "SHEET A-101  REV C")


def compose(factory, frame):
    sheet = Sheet()
    for draw in (draw_walls, draw_doors, draw_floor, draw_axes, draw_dimensions):
        draw(sheet, factory)
    draw_title(sheet, factory, frame)
    return sheet
