#!/usr/bin/python3
"""Scores wall detection on the shared drawings in other shapes: turned, mirrored, resized, thicker strokes,
blurred, inverted. What holds only for the file as it came is no rule.

  cmake --build build/release --target bench_detect_walls && tests/bench/score_shapes.py [--only DRAWING,...] [--shapes A,...]

F1 at the tolerance of ../shared/score/walls.py (0.15 m of the building, whatever the shape)."""
import argparse
import importlib.util
import math
import pathlib
import subprocess
import tempfile

import numpy as np
from PIL import Image, ImageFilter, ImageOps

import score_walls

Image.MAX_IMAGE_PIXELS = None
TOLERANCE_M, ANGLE_DEG, STEP_M = 0.15, 10, 0.02


def resized(factor):
    def shape(image):
        size = [max(1, round(s * factor)) for s in image.size]
        real = [new / old for new, old in zip(size, image.size)]
        return image.resize(size, Image.LANCZOS if factor > 1 else Image.BOX), lambda p: p * real, factor
    return shape


def turned(degrees):
    """Counter-clockwise about the middle, the sheet grown to hold it."""
    def shape(image):
        angle = math.radians(degrees)
        c, s = math.cos(angle), math.sin(angle)
        out = image.rotate(degrees, Image.BICUBIC, expand=True, fillcolor=255)
        middle, new = np.array(image.size) / 2, np.array(out.size) / 2
        turn = np.array([[c, s], [-s, c]])  # v points down
        return out, lambda p: (p - middle) @ turn.T + new, 1.0
    return shape


def filtered(picture):
    return lambda image: (picture(image), lambda p: p, 1.0)


def mirrored(image):
    return ImageOps.mirror(image), lambda p: p * (-1, 1) + (image.width, 0), 1.0


def thickened(image):
    """Every stroke one pixel thicker: a pixel is as dark as the darkest of the four from it to upper left."""
    grey = np.pad(np.asarray(image), ((1, 0), (1, 0)), mode="edge")
    return Image.fromarray(np.minimum.reduce([grey[1:, 1:], grey[:-1, 1:], grey[1:, :-1], grey[:-1, :-1]]))


SHAPES = {
    "as it is": filtered(lambda i: i),
    "turned 1.5": turned(1.5),
    "turned 30": turned(30),
    "turned 90": turned(90),
    "mirrored": mirrored,
    "x 0.5": resized(0.5),
    "x 0.7": resized(0.7),
    "x 1.5": resized(1.5),
    "x 2": resized(2),
    "thicker": filtered(thickened),
    "blurred": filtered(lambda i: i.filter(ImageFilter.GaussianBlur(1.2))),
    "inverted": filtered(ImageOps.invert),
}


def scorer():
    spec = importlib.util.spec_from_file_location("walls", score_walls.SCORER)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def on_white(picture):
    image = Image.open(picture).convert("RGBA")
    return Image.alpha_composite(Image.new("RGBA", image.size, "white"), image).convert("L")


def score(walls, image, truth_px, scale, shape, folder):
    changed, move, factor = shape(image)
    changed.save(folder / "drawing.png", compress_level=1)
    scale /= factor
    detected = folder / "walls.csv"
    subprocess.run([score_walls.BENCH, folder / "drawing.png", "--scale", str(scale), "--out", detected],
                   check=True, stdout=subprocess.DEVNULL)
    found = walls.read_segments(detected, ["x1", "y1", "x2", "y2"])
    if not len(found):
        return 0.0, 0.0, 0.0, 0.0
    truth = (move(truth_px) * (1, -1) + (0, changed.height)) * scale
    precision = walls.share(found, walls.near_and_parallel(found, truth, TOLERANCE_M, ANGLE_DEG, STEP_M))
    recall = walls.share(truth, walls.near_and_parallel(truth, found, TOLERANCE_M, ANGLE_DEG, STEP_M))
    both = precision + recall
    length = walls.lengths(found).sum() / walls.lengths(truth).sum()
    return precision, recall, 2 * precision * recall / both if both else 0.0, length


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="sample_factory,office,clinic,hotel_L1")
    parser.add_argument("--shapes", default=",".join(SHAPES))
    parser.add_argument("--detail", action="store_true", help="precision, recall and length beside F1")
    args = parser.parse_args()
    if not score_walls.SCORER.exists():
        print(f"skipped: {score_walls.SCORER} is not there")
        return
    walls, names = scorer(), args.shapes.split(",")
    print(f"{'drawing':20}" + "".join(f"{name:>12}" for name in names), flush=True)
    with tempfile.TemporaryDirectory() as temporary:
        for drawing, picture, truth, scale in score_walls.drawings():
            if drawing not in args.only.split(","):
                continue
            image, truth_px = on_white(picture), walls.read_segments(truth, ["u1", "v1", "u2", "v2"])
            print(f"{drawing:20}", end="", flush=True)
            for name in names:
                p, r, f1, length = score(walls, image, truth_px, scale, SHAPES[name], pathlib.Path(temporary))
                print(f"{f1:12.3f}" if not args.detail else f"{f1:.3f}({p:.2f}/{r:.2f}/{length:.1f}) ",
                      end="", flush=True)
            print()


if __name__ == "__main__":
    main()
