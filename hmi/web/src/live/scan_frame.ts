/** "MDS1", u32 count, count pairs of f32; null for anything else. Little-endian, as every browser's machine is. */
export function parseScan(frame: ArrayBuffer): Float32Array<ArrayBuffer> | null {
  if (frame.byteLength < 8) return null;
  const view = new DataView(frame);
  if (view.getUint32(0, false) !== 0x4d445331) return null;
  const count = view.getUint32(4, true);
  if (frame.byteLength !== 8 + 8 * count) return null;
  return new Float32Array(frame, 8, 2 * count);
}
