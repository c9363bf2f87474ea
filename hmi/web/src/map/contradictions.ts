import type { Scan } from "../live/scan_frame";
import { distanceToSegment, type XY } from "./geometry";

export type Piece = [number, number, number, number];
export interface Fit {
  /** share of what is seen that ends on a drawn wall, 0 to 1 */
  share: number;
  /** pieces of wall that the lidar looks through from there */
  contradicted: Piece[];
}

const kPiece_m = 1;
const kOn_m = 0.2;
const kBehind_m = 0.4;
const kLeastBeams = 3;

/** Walls cut into pieces of about a metre. */
export function piecesOf(walls: readonly number[][]): Piece[] {
  return walls.flatMap(([x1 = 0, y1 = 0, x2 = 0, y2 = 0]) => {
    const count = Math.max(1, Math.round(Math.hypot(x2 - x1, y2 - y1) / kPiece_m));
    const at = (i: number): XY => [x1 + ((x2 - x1) * i) / count, y1 + ((y2 - y1) * i) / count];
    return Array.from({ length: count }, (_, i): Piece => [...at(i), ...at(i + 1)]);
  });
}

/** How far along the beam from `from` to `to`, 0 to 1, it meets a piece; Infinity where it does not. */
function meets([ax, ay]: XY, [bx, by]: XY, [x1, y1, x2, y2]: Piece): number {
  const [dx, dy, ex, ey] = [bx - ax, by - ay, x2 - x1, y2 - y1];
  const cross = dx * ey - dy * ex;
  if (cross === 0) return Infinity;
  const along = ((x1 - ax) * ey - (y1 - ay) * ex) / cross;
  const share = ((x1 - ax) * dy - (y1 - ay) * dx) / cross;
  return along >= 0 && along <= 1 && share >= 0 && share <= 1 ? along : Infinity;
}

/**
 * What the drawn walls say of a place: how much of the scan ends on them, and through which of them it looks. A beam that
 * ends before a wall says nothing of it, and one that ends on its face confirms it.
 */
export function fitAt(pieces: readonly Piece[], scan: Scan, pose: { x: number; y: number; yaw: number }): Fit {
  const from: XY = [pose.x, pose.y];
  const [c, s] = [Math.cos(pose.yaw), Math.sin(pose.yaw)];
  const through = new Int32Array(pieces.length);
  const on = new Int32Array(pieces.length);
  let fitting = 0;
  let beams = 0;
  for (let i = 0; i + 1 < scan.points.length; i += 2) {
    const [px = 0, py = 0] = [scan.points[i], scan.points[i + 1]];
    const to: XY = [pose.x + c * px - s * py, pose.y + s * px + c * py];
    const length = Math.hypot(px, py);
    if (length < 0.5) continue;
    ++beams;
    let ended = false;
    pieces.forEach((piece, k) => {
      if (Math.min(piece[0], piece[2]) > Math.max(from[0], to[0]) + kOn_m || Math.max(piece[0], piece[2]) < Math.min(from[0], to[0]) - kOn_m) return;
      if (Math.min(piece[1], piece[3]) > Math.max(from[1], to[1]) + kOn_m || Math.max(piece[1], piece[3]) < Math.min(from[1], to[1]) - kOn_m) return;
      if (distanceToSegment(to, piece) < kOn_m) {
        on[k] = (on[k] ?? 0) + 1;
        ended = true;
      } else if (length * (1 - meets(from, to, piece)) > kBehind_m) through[k] = (through[k] ?? 0) + 1;
    });
    if (ended) ++fitting;
  }
  const contradicted = pieces.filter((_, k) => (through[k] ?? 0) >= kLeastBeams && (through[k] ?? 0) > 2 * (on[k] ?? 0));
  return { share: beams === 0 ? 0 : fitting / beams, contradicted };
}
