#!/usr/bin/python3
"""Draws the sample factory again and compares every file with the one that is shipped. Argument: its folder."""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image


def same(shipped, drawn):
    if shipped.suffix == ".png":  # another zlib may pack the same picture differently
        return np.array_equal(np.asarray(Image.open(shipped)), np.asarray(Image.open(drawn)))
    return shipped.read_bytes() == drawn.read_bytes()


def main():
    shipped = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        subprocess.run([sys.executable, "-B", shipped / "draw.py", "--out", out], check=True)
        names = sorted(p.relative_to(out) for p in out.rglob("*") if p.is_file())
        if len(names) != 10:
            sys.exit(f"draw.py wrote {len(names)} files, not 10: {names}")
        different = [str(n) for n in names if not same(shipped / n, out / n)]
    if different:
        sys.exit(f"not as drawn: {', '.join(different)} - run {shipped / 'draw.py'} and commit what it wrote")


if __name__ == "__main__":
    main()
