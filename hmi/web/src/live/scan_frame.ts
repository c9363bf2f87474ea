/** A scan in the Base frame, metres, and where the vehicle was believed to stand when it was made (Map frame). */
export interface Scan {
  x: number;
  y: number;
  yaw: number;
  /** x, y pairs */
  points: Float32Array;
}

export const noScan: Scan = { x: 0, y: 0, yaw: 0, points: new Float32Array() };

const kHeaderBytes = 36;

/**
 * "MDS2", u32 count, f64 x, f64 y, f64 yaw, f32 unit in metres, then count pairs of i16 in that unit; null for anything
 * else. Little-endian, as every browser's machine is.
 */
export function parseScan(frame: ArrayBuffer): Scan | null {
  if (frame.byteLength < 8) return null;
  const view = new DataView(frame);
  const count = view.getUint32(4, true);
  if (view.getUint32(0, false) !== 0x4d445332 || frame.byteLength !== kHeaderBytes + 4 * count) return null;
  const unit = view.getFloat32(32, true);
  const steps = new Int16Array(frame, kHeaderBytes, 2 * count);
  const points = new Float32Array(2 * count);
  for (let i = 0; i < points.length; ++i) points[i] = unit * (steps[i] ?? 0);
  return { x: view.getFloat64(8, true), y: view.getFloat64(16, true), yaw: view.getFloat64(24, true), points };
}
