import type { VehicleInfo } from "../api_types";

export type XY = [number, number];
export type Extent = [number, number, number, number];

export const extentOf = (width: number, height: number): Extent => [0, 0, width, height];

/** The outline of the vehicle with a pointed front; pose in metres and radians. */
export function footprint(pose: { x: number; y: number; yaw: number }, vehicle: Pick<VehicleInfo, "length_m" | "width_m" | "base_to_rear_m">): XY[] {
  const rear = -vehicle.base_to_rear_m;
  const front = rear + vehicle.length_m;
  const half = vehicle.width_m / 2;
  const nose = Math.min(half, vehicle.length_m / 3);
  const outline: XY[] = [[rear, -half], [front - nose, -half], [front, 0], [front - nose, half], [rear, half], [rear, -half]];
  const c = Math.cos(pose.yaw);
  const s = Math.sin(pose.yaw);
  return outline.map(([x, y]) => [pose.x + c * x - s * y, pose.y + s * x + c * y]);
}

/** The ellipse of `sigmas` standard deviations of a covariance xx, xy, yy. */
export function ellipseRing(centre: XY, covariance: readonly number[], sigmas: number): XY[] {
  const [xx = 0, xy = 0, yy = 0] = covariance;
  const mean = (xx + yy) / 2;
  const spread = Math.hypot((xx - yy) / 2, xy);
  const angle = 0.5 * Math.atan2(2 * xy, xx - yy);
  const a = sigmas * Math.sqrt(Math.max(mean + spread, 0));
  const b = sigmas * Math.sqrt(Math.max(mean - spread, 0));
  const ring: XY[] = [];
  for (let i = 0; i <= 32; ++i) {
    const t = (2 * Math.PI * i) / 32;
    const u = a * Math.cos(t);
    const v = b * Math.sin(t);
    ring.push([centre[0] + u * Math.cos(angle) - v * Math.sin(angle), centre[1] + u * Math.sin(angle) + v * Math.cos(angle)]);
  }
  return ring;
}

/** Map metres to drawing pixels (v down) and back: x = u * s, y = (height - v) * s. */
export const toPixel = ([x, y]: XY, height_px: number, m_per_px: number): XY => [x / m_per_px, height_px - y / m_per_px];
export const toMap = ([u, v]: XY, height_px: number, m_per_px: number): XY => [u * m_per_px, (height_px - v) * m_per_px];

/** The index of the nearest of some points within `reach`; -1 where none is. */
export function nearest(points: readonly XY[], at: XY, reach: number): number {
  let best = -1;
  let least = reach;
  points.forEach(([x, y], index) => {
    const distance = Math.hypot(x - at[0], y - at[1]);
    if (distance <= least) {
      least = distance;
      best = index;
    }
  });
  return best;
}

/** The distance of a point from the segment x1, y1, x2, y2. */
export function distanceToSegment([x, y]: XY, [x1 = 0, y1 = 0, x2 = 0, y2 = 0]: readonly number[]): number {
  const dx = x2 - x1;
  const dy = y2 - y1;
  const length2 = dx * dx + dy * dy;
  const t = length2 > 0 ? Math.min(1, Math.max(0, ((x - x1) * dx + (y - y1) * dy) / length2)) : 0;
  return Math.hypot(x - x1 - t * dx, y - y1 - t * dy);
}
