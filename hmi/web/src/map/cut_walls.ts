import { distanceToSegment, type XY } from "./geometry";

const kOn_m = 0.02; // of a wall's line: its pieces are computed from its ends
const kShortest_m = 0.05; // what is left of a wall and shorter is nothing to drive by

/** Walls (x1, y1, x2, y2, whatever follows) without the stretches that are gone: a wall may become two, or none. */
export function cutOut(walls: readonly (readonly number[])[], gone: readonly (readonly number[])[]): number[][] {
  return walls.flatMap((wall) => {
    const cuts = gone.flatMap((piece) => shareOn(wall, piece)).sort(([a], [b]) => a - b);
    return cuts.length === 0 ? [[...wall]] : leftOver(wall, cuts);
  });
}

/** Which part of a wall a piece covers, from 0 at its start to 1 at its end; none where the piece is not of this wall. */
function shareOn(wall: readonly number[], [px1 = 0, py1 = 0, px2 = 0, py2 = 0]: readonly number[]): XY[] {
  if (Math.max(distanceToSegment([px1, py1], wall), distanceToSegment([px2, py2], wall)) > kOn_m) return [];
  const [x1 = 0, y1 = 0, x2 = 0, y2 = 0] = wall;
  const length2 = (x2 - x1) ** 2 + (y2 - y1) ** 2;
  const along = (x: number, y: number) => ((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / length2;
  const [from, to] = [along(px1, py1), along(px2, py2)].sort((a, b) => a - b);
  if (from === undefined || to === undefined || !((to - from) * Math.sqrt(length2) >= kShortest_m)) return [];
  return [[from, to]];
}

function leftOver(wall: readonly number[], cuts: readonly XY[]): number[][] {
  const [x1 = 0, y1 = 0, x2 = 0, y2 = 0, ...more] = wall;
  const length = Math.hypot(x2 - x1, y2 - y1);
  const rows: number[][] = [];
  let begin = 0;
  for (const [from, to] of [...cuts, [1, 1] as XY]) {
    if ((from - begin) * length > kShortest_m) {
      const at = (share: number) => [x1 + share * (x2 - x1), y1 + share * (y2 - y1)];
      rows.push([...at(begin), ...at(from), ...more]);
    }
    begin = Math.max(begin, to);
  }
  return rows;
}
