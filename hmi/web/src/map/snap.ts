import type { XY } from "./geometry";
import { nearest } from "./geometry";

type Wall = readonly number[];

const end = (wall: Wall, last: boolean): XY => (last ? [wall[2] ?? 0, wall[3] ?? 0] : [wall[0] ?? 0, wall[1] ?? 0]);

/** Where the lines of two walls meet; null where they are nearly parallel. */
function crossing(a: Wall, b: Wall): XY | null {
  const [ax, ay] = end(a, false);
  const [bx, by] = end(b, false);
  const ux = (a[2] ?? 0) - ax;
  const uy = (a[3] ?? 0) - ay;
  const vx = (b[2] ?? 0) - bx;
  const vy = (b[3] ?? 0) - by;
  const cross = ux * vy - uy * vx;
  if (Math.abs(cross) < 0.2 * Math.hypot(ux, uy) * Math.hypot(vx, vy)) return null;
  const t = ((bx - ax) * vy - (by - ay) * vx) / cross;
  return [ax + t * ux, ay + t * uy];
}

/**
 * The corners of some walls: wall ends, drawn together to where two walls would meet when both end within `gap` of
 * it. Units are those of the walls.
 */
export function corners(walls: readonly Wall[], gap: number): XY[] {
  const ends = walls.flatMap((wall, index) => [false, true].map((last) => ({ at: end(wall, last), index })));
  const cells = new Map<string, typeof ends>();
  const cell = (x: number, y: number) => `${Math.floor(x / gap)},${Math.floor(y / gap)}`;
  for (const one of ends) {
    const key = cell(one.at[0], one.at[1]);
    cells.set(key, [...(cells.get(key) ?? []), one]);
  }
  const around = ([x, y]: XY) =>
    [-1, 0, 1].flatMap((i) => [-1, 0, 1].flatMap((j) => cells.get(cell(x + i * gap, y + j * gap)) ?? []));
  return ends.map(({ at, index }) => {
    for (const other of around(at)) {
      if (other.index === index || Math.hypot(other.at[0] - at[0], other.at[1] - at[1]) > gap) continue;
      const meeting = crossing(walls[index] ?? [], walls[other.index] ?? []);
      if (meeting && Math.hypot(meeting[0] - at[0], meeting[1] - at[1]) <= gap) return meeting;
    }
    return at;
  });
}

/** The corners, and the middles between those nearer than `thickness`: a drawn wall has an inner and an outer one. */
export function withMiddles(points: readonly XY[], thickness: number): XY[] {
  const middles: XY[] = [];
  points.forEach(([ax, ay], i) => {
    for (const [bx, by] of points.slice(i + 1)) {
      const apart = Math.hypot(bx - ax, by - ay);
      if (apart > thickness / 20 && apart <= thickness) middles.push([(ax + bx) / 2, (ay + by) / 2]);
    }
  });
  return [...points, ...middles];
}

/** The corner within `reach` of a place, or the place itself. */
export function snapTo(points: readonly XY[], at: XY, reach: number): { at: XY; snapped: boolean } {
  const found = points[nearest(points, at, reach)];
  return found ? { at: found, snapped: true } : { at, snapped: false };
}
