"""Draws the pictures of scale-your-drawing.md from the sample factory. Run: python3 docs/how-to/pictures/draw.py"""
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

HERE = pathlib.Path(__file__).parent
Image.MAX_IMAGE_PIXELS = None
SCAN = Image.open(HERE / "../../../data/sample_factory/factory_scan.png").convert("L")
W, H = SCAN.size
SMALL = np.asarray(SCAN.resize((W // 4, H // 4)))


def sheet(title):
    figure, axes = plt.subplots(figsize=(7.2, 5.2), dpi=90)
    axes.imshow(SMALL, cmap="gray", vmin=-150, vmax=255, extent=(0, W, H, 0))
    axes.set(title=title, xlabel="u, pixels to the right", ylabel="v, pixels down")
    return figure, axes


def save(figure, name):
    figure.tight_layout()
    figure.savefig(HERE / name)
    plt.close(figure)


def known():
    figure, axes = sheet("--known: lengths that were measured")
    for (u1, v1, u2, v2), text in (((525, 515, 3415, 450), "1"), ((3690, 930, 3740, 2430), "2"),
                                   ((525, 525, 3735, 2425), "3")):
        axes.annotate("", (u1, v1), (u2, v2), arrowprops={"arrowstyle": "<->", "color": "C3", "lw": 2})
        axes.text((u1 + u2) / 2, (v1 + v2) / 2, text, color="w", ha="center", va="center",
                  bbox={"boxstyle": "circle", "fc": "C3"})
    save(figure, "scale-known.png")


def control():
    figure, axes = sheet("--control: four corners whose place on Earth is known")
    for i, (u, v) in enumerate(((515, 510), (3415, 450), (3745, 2435), (535, 2505))):
        axes.plot(u, v, "o", ms=14, mfc="none", mec="C0", mew=2.5)
        axes.text(u - 250, v - 90, f"{i + 1}: LAT,LON", color="C0", weight="bold")
    save(figure, "scale-control.png")


def overlay():
    figure, axes = plt.subplots(figsize=(7.2, 5.2), dpi=90)
    for k in range(5):
        axes.axvline(k * 256, color="C2", lw=1)
        axes.axhline(k * 256, color="C2", lw=1)
    axes.text(8, 34, "tiles of the photograph, 256 px each, L_t metres", color="C2")
    turned = Image.fromarray(SMALL).rotate(12, expand=True, fillcolor=255)
    axes.imshow(np.asarray(turned), cmap="gray", alpha=0.75, extent=(180, 180 + 660, 880, 880 - 660 * turned.height / turned.width))
    axes.annotate("drawing at layout=Z_m,\nturned by rotation_deg", (700, 420), (600, 170), arrowprops={"arrowstyle": "->"})
    axes.plot(510, 640, "+", ms=18, color="C3", mew=3)
    axes.text(400, 720, "anchor u,v at lat,lon + east_m,north_m", color="C3")
    axes.set(xlim=(0, 1024), ylim=(960, 0), title="--overlay: the drawing over a photograph at photo=Z_p")
    save(figure, "scale-overlay.png")


def paper():
    figure, axes = plt.subplots(figsize=(7.2, 3.4), dpi=90)
    part = SMALL[int(SMALL.shape[0] * 0.8):, int(SMALL.shape[1] * 0.55):]
    axes.imshow(part, cmap="gray", extent=(0, part.shape[1], part.shape[0], 0))
    axes.set(title="--paper: the scale in the title block, e.g. 1:200, and the scanner's dpi", xticks=[], yticks=[])
    save(figure, "scale-paper.png")


known()
control()
overlay()
paper()
