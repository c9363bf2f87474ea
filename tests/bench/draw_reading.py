#!/usr/bin/python3
"""Draws the pictures of docs/explanation/how-walls-are-found.md: a plan of the draughtsman that no model was trained on, at each
stage of its import.

  cmake --build build/release --target draughtsman madori && tests/bench/draw_reading.py [--seed N]"""
import argparse
import pathlib
import subprocess
import tempfile

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/release"
WIDTH = 1000  # pixels of the pictures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=20003, help="of the plan; training uses 1 to 400 (default %(default)s)")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/images")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([BUILD / "tests/bench/draughtsman", folder, "--plans", "1", "--first-seed", str(args.seed)], check=True)
        site = folder / "site"
        subprocess.run([BUILD / "madori", "import", folder / f"plan_{args.seed}.png", "--site", site, "--debug-images"],
                       check=True, stdout=subprocess.DEVNULL)
        for stage, file in [(file.stem.split("-", 1)[1], file) for file in (site / "debug").glob("*.png")] + [("import", site / "import.png")]:
            picture = Image.open(file).convert("RGB")
            picture = picture.resize((WIDTH, round(picture.height * WIDTH / picture.width)), Image.LANCZOS)
            picture.quantize(32, dither=Image.Dither.NONE).save(args.out / f"reading-{stage}.png", optimize=True)


if __name__ == "__main__":
    main()
