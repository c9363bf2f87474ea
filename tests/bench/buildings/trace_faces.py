#!/usr/bin/python3
"""Walls as a careful person traces them: every face of every wall in the two shared drawings whose walls a colour tells.

  trace_faces.py DATA FOLDER      then: bench_buildings --hand-made FOLDER

DATA is ../shared/data. Writes FOLDER/BUILDING/walls.csv (u1,v1,u2,v2: pixels, v down) and walls.png to look at. The
regions of the wall's ink (hotel_L1) or of the floor (intel) are outlined to 1.2 pixels; what is no wall was picked by
eye (hotel_L1: compass, title, sofa, stair, the words). Nothing of the import is used, so that its walls can be judged
by what localization makes of both. Needs python3-opencv."""
import pathlib
import sys

import cv2
import numpy as np

TOLERANCE_PX = 1.2
NO_WALLS = [(440, 140, 600, 365), (553, 474, 588, 546), (280, 478, 420, 530), (136, 355, 165, 380), (148, 150, 195, 295)]


def without_small(mask, is_small):
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=4)
    for i in range(1, count):
        if is_small(stats[i]):
            mask[labels == i] = 0
    return mask


def hotel(data):
    picture = cv2.imread(str(data / "drawings/hotel_L1/hotel_L1.png"), cv2.IMREAD_UNCHANGED)
    alpha = picture[:, :, 3:] / 255.0
    grey = (picture[:, :, :3] * alpha + 255 * (1 - alpha)).mean(2)
    ink = cv2.morphologyEx((grey < 150).astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    for u1, v1, u2, v2 in NO_WALLS:
        ink[v1:v2, u1:u2] = 0
    return grey, without_small(ink, lambda s: max(s[cv2.CC_STAT_WIDTH], s[cv2.CC_STAT_HEIGHT]) < 30)


def intel(data):
    grey = cv2.imread(str(data / "lidar2d/intel/layout.png"), cv2.IMREAD_GRAYSCALE)
    return grey, without_small((grey > 240).astype(np.uint8), lambda s: s[cv2.CC_STAT_AREA] < 150)


def faces(mask):
    """-> (n, 4): u1, v1, u2, v2 of every side of every region that is longer than two pixels."""
    outlines, _ = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    rows = []
    for outline in outlines:
        corners = cv2.approxPolyDP(outline, TOLERANCE_PX, True)[:, 0, :] + 0.5
        rows += [(*a, *b) for a, b in zip(corners, np.roll(corners, -1, 0)) if np.hypot(*(a - b)) > 2.0]
    return np.array(rows)


def main():
    data, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    for name, read in [("hotel_L1", hotel), ("intel", intel)]:
        grey, mask = read(data)
        walls = faces(mask)
        (folder / name).mkdir(parents=True, exist_ok=True)
        np.savetxt(folder / name / "walls.csv", walls, "%.1f", ",", header="u1,v1,u2,v2", comments="")
        look = cv2.cvtColor((grey / 2 + 127).astype(np.uint8), cv2.COLOR_GRAY2BGR)
        for u1, v1, u2, v2 in walls.astype(int):
            cv2.line(look, (u1, v1), (u2, v2), (255, 0, 0), 1)
        cv2.imwrite(str(folder / name / "walls.png"), look)
        print(f"{name}: {len(walls)} faces")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main()
