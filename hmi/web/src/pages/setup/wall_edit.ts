import { distanceToSegment, type XY } from "../../map/geometry";

export type WallRow = number[];

/** Without the wall that is nearest to a place, within reach; the same list where none is. */
export function eraseAt(walls: readonly WallRow[], at: XY, reach: number): WallRow[] {
  let nearest = -1;
  let least = reach;
  walls.forEach((wall, index) => {
    const distance = distanceToSegment(at, wall);
    if (distance > least) return;
    least = distance;
    nearest = index;
  });
  return nearest < 0 ? [...walls] : walls.filter((_, index) => index !== nearest);
}

/** Without the walls that lie wholly inside the rectangle of two corners. */
export function eraseInside(walls: readonly WallRow[], a: XY, b: XY): WallRow[] {
  const inside = (x: number, y: number) =>
    x >= Math.min(a[0], b[0]) && x <= Math.max(a[0], b[0]) && y >= Math.min(a[1], b[1]) && y <= Math.max(a[1], b[1]);
  return walls.filter(([x1 = 0, y1 = 0, x2 = 0, y2 = 0]) => !inside(x1, y1) || !inside(x2, y2));
}

export const addWall = (walls: readonly WallRow[], a: XY, b: XY): WallRow[] => [...walls, [...a, ...b, -1]];

export const totalLength = (walls: readonly WallRow[]): number =>
  walls.reduce((sum, [x1 = 0, y1 = 0, x2 = 0, y2 = 0]) => sum + Math.hypot(x2 - x1, y2 - y1), 0);
