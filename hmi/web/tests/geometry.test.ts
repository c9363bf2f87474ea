import { describe, expect, it } from "vitest";
import { EditHistory } from "../src/edit_history";
import { parseScan } from "../src/live/scan_frame";
import { distanceToSegment, ellipseRing, footprint, toMap, toPixel } from "../src/map/geometry";

describe("geometry", () => {
  it("turns map metres into pixels and back, v down", () => {
    expect(toPixel([1, 2], 100, 0.1)).toEqual([10, 80]);
    expect(toMap([10, 80], 100, 0.1)).toEqual([1, 2]);
  });

  it("draws the vehicle with its nose forward", () => {
    const outline = footprint({ x: 10, y: 5, yaw: Math.PI / 2 }, { length_m: 1, width_m: 0.6, base_to_rear_m: 0.2 });
    const nose = outline[2] ?? [0, 0];
    expect(nose[0]).toBeCloseTo(10);
    expect(nose[1]).toBeCloseTo(5.8);
  });

  it("draws two standard deviations", () => {
    const ring = ellipseRing([0, 0], [4, 0, 1, 0], 2);
    expect(Math.max(...ring.map(([x]) => x))).toBeCloseTo(4);
    expect(Math.max(...ring.map(([, y]) => y))).toBeCloseTo(2);
  });

  it("measures the distance to a wall, its ends included", () => {
    expect(distanceToSegment([5, 3], [0, 0, 10, 0])).toBe(3);
    expect(distanceToSegment([13, 4], [0, 0, 10, 0])).toBe(5);
    expect(distanceToSegment([3, 4], [0, 0, 0, 0])).toBe(5);
  });
});

describe("a scan frame", () => {
  const frame = new ArrayBuffer(44);
  const view = new DataView(frame);
  view.setUint32(0, 0x4d445332);
  view.setUint32(4, 2, true);
  [10, -3, 0.5].forEach((value, i) => view.setFloat64(8 + 8 * i, value, true));
  view.setFloat32(32, 0.01, true);
  [150, -225, 32767, -32768].forEach((value, i) => view.setInt16(36 + 2 * i, value, true));

  it("is read: pose, and points in its unit", () => {
    const scan = parseScan(frame);
    expect([scan?.x, scan?.y, scan?.yaw]).toEqual([10, -3, 0.5]);
    [1.5, -2.25, 327.67, -327.68].forEach((value, i) => expect(scan?.points[i]).toBeCloseTo(value, 4));
  });
  it("of the wrong size or kind is nothing", () => {
    expect(parseScan(frame.slice(0, 40))).toBeNull();
    expect(parseScan(new ArrayBuffer(4))).toBeNull();
    expect(parseScan(new ArrayBuffer(44))).toBeNull();
  });
});

describe("undo and redo", () => {
  it("walk back and forth, and a new change forgets what was undone", () => {
    const history = new EditHistory(1);
    history.change(2);
    history.change(3);
    history.undo();
    expect([history.value, history.canUndo, history.canRedo]).toEqual([2, true, true]);
    history.redo();
    expect(history.value).toBe(3);
    history.undo();
    history.change(9);
    expect([history.value, history.canRedo]).toEqual([9, false]);
  });
});
