"""A Sheet as DXF, PDF and a scanned picture."""
import math
import re

import ezdxf
import numpy as np
from PIL import Image, ImageDraw, ImageFont
from reportlab.pdfgen import canvas as pdf

from geometry import arc_points
from sheet import LAYERS

FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
MM = 72.0 / 25.4  # PDF points


def write_dxf(sheet, path):
    document = ezdxf.new("R2010", setup=True)
    document.header["$INSUNITS"] = 4  # millimetres
    document.header["$MEASUREMENT"] = 1
    model = document.modelspace()
    for name, (pen, dash) in LAYERS.items():
        linetype = "CONTINUOUS" if dash is None else "DASHED" if len(dash) == 2 else "DASHDOT"
        document.layers.add(name, linetype=linetype, lineweight=round(100 * pen))
    mm = lambda p: (1000 * p[0], 1000 * p[1])
    for layer, points in sheet.strokes:
        if len(points) == 2:
            model.add_line(mm(points[0]), mm(points[1]), {"layer": layer})
        else:
            closed = points[0] == points[-1]
            model.add_lwpolyline([mm(p) for p in (points[:-1] if closed else points)], close=closed, dxfattribs={"layer": layer})
    for layer, centre, radius, start, end in sheet.circles:
        if end - start >= 360:
            model.add_circle(mm(centre), 1000 * radius, {"layer": layer})
        else:
            model.add_arc(mm(centre), 1000 * radius, start, end, dxfattribs={"layer": layer})
    for layer, at, height, angle, text in sheet.texts:
        model.add_text(text, dxfattribs={"layer": layer, "height": 1000 * height, "rotation": angle, "insert": mm(at)})
    ezdxf.options.write_fixed_meta_data_for_testing = True  # the same file on every run
    document.saveas(path)
    stamped = path.read_text(encoding="utf-8")
    path.write_text(re.sub(r"@ \d{4}-\d\d-\d\dT\S+", "@ 2024-03-14", stamped), encoding="utf-8")


def write_pdf(sheet, path, frame, millimetres, scale):
    x0, y0, _, _ = frame
    to_points = lambda p: ((p[0] - x0) * 1000 / scale * MM, (p[1] - y0) * 1000 / scale * MM)
    page = pdf.Canvas(str(path), pagesize=(millimetres[0] * MM, millimetres[1] * MM), invariant=1)
    curves = [(l, arc_points(c, r, a, b, 6.0)) for l, c, r, a, b in sheet.circles]
    for layer, points in [*sheet.strokes, *curves]:
        pen, dash = LAYERS[layer]
        page.setLineWidth(pen * MM)
        page.setDash([d * MM for d in dash] if dash else [])
        line = page.beginPath()
        line.moveTo(*to_points(points[0]))
        for p in points[1:]:
            line.lineTo(*to_points(p))
        page.drawPath(line)
    for _, at, height, angle, text in sheet.texts:
        page.saveState()
        page.translate(*to_points(at))
        page.rotate(angle)
        page.setFont("Helvetica", height * 1000 / scale * MM * 1.35)
        page.drawString(0, 0, text)
        page.restoreState()
    page.save()


def dashes(points, pattern):
    """The inked pieces of a line; pattern: ink, gap, ink, gap ... in metres."""
    for a, b in zip(points[:-1], points[1:]):
        length = math.dist(a, b)
        at, index = 0.0, 0
        while at < length:
            end = min(length, at + pattern[index % len(pattern)])
            if index % 2 == 0:
                yield [tuple(a[k] + (b[k] - a[k]) * s / length for k in (0, 1)) for s in (at, end)]
            at, index = end, index + 1


def draw_raster(sheet, frame, size_px, m_per_px, scale, oversampling=2):
    """8-bit grey, 255 paper; drawn larger and reduced, as a print is smooth."""
    x0, _, _, y1 = frame
    zoom = oversampling / m_per_px
    at = lambda p: ((p[0] - x0) * zoom, (y1 - p[1]) * zoom)
    image = Image.new("L", (size_px[0] * oversampling, size_px[1] * oversampling), 255)
    draw = ImageDraw.Draw(image)
    curves = [(l, arc_points(c, r, a, b, 5.0)) for l, c, r, a, b in sheet.circles]
    for layer, points in [*sheet.strokes, *curves]:
        pen, dash = LAYERS[layer]
        width = max(1, round(pen * scale / 1000 * zoom))
        pieces = dashes(points, [d * scale / 1000 for d in dash]) if dash else [points]
        for piece in pieces:
            draw.line([at(p) for p in piece], fill=20, width=width, joint="curve")
    for _, where, height, angle, text in sheet.texts:
        font = ImageFont.truetype(FONT, max(6, round(1.35 * height * zoom)))
        left, top, right, bottom = font.getbbox(text)
        stamp = Image.new("L", (right + 4, bottom + 4), 0)
        ImageDraw.Draw(stamp).text((2, 2), text, font=font, fill=255)
        turned = stamp.rotate(angle, expand=True)
        u, v = at(where)
        image.paste(20, (round(u) - (turned.width if angle > 45 else 0), round(v) - turned.height), turned)
    return image.reduce(oversampling)


def scan(clean, skew_deg, seed):
    """What a scanner makes of a folded print: skew, uneven paper, folds, dirt and noise."""
    random = np.random.default_rng(seed)
    width, height = clean.size
    turned = np.asarray(clean.rotate(skew_deg, resample=Image.BICUBIC, fillcolor=255), dtype=np.float32)
    v, u = np.mgrid[0:height, 0:width].astype(np.float32)
    paper = 243 - 10 * (u / width) ** 2 - 8 * np.sin(3 * v / height) ** 2
    for fold in (0.26, 0.5, 0.75):  # vertical folds: a dark line beside a bright one
        position = fold * width + 6 * np.sin(v / 400)
        paper -= 16 * np.exp(-((u - position) / 3.0) ** 2) - 7 * np.exp(-((u - position - 9) / 5.0) ** 2)
    paper -= 18 * np.exp(-((v - 0.5 * height - 5 * np.sin(u / 500)) / 3.0) ** 2)
    result = paper * (turned / 255.0) + 30 * (1 - turned / 255.0)
    result += random.normal(0, 1.5, result.shape)
    dirt = random.random(result.shape) < 2e-5
    result[dirt] -= random.uniform(60, 160, int(dirt.sum()))
    return Image.fromarray((np.clip(np.round(result / 12) * 12, 0, 255)).astype(np.uint8))
