import { describe, expect, it } from "vitest";
import { pushAt, pushOf, pushOfPad } from "../src/ui/jog_push";

describe("driving by hand", () => {
  it("takes the round pad's middle for a stand and its rim for full speed", () => {
    expect(pushAt(0, 0)).toEqual([0, 0]);
    expect(pushAt(0.1, 0.05)).toEqual([0, 0]);
    expect(pushAt(0, 1)).toEqual([1, 0]);
    expect(pushAt(0, -3)).toEqual([-1, 0]);
    expect(pushAt(1, 0)).toEqual([0, -1]);
    const [ahead, left] = pushAt(-0.5, 0.5);
    expect(ahead).toBeCloseTo(left);
    expect(ahead).toBeGreaterThan(0.4);
  });

  it("never asks for more than full speed, wherever the finger goes", () => {
    for (let i = 0; i < 360; ++i) {
      const [ahead, left] = pushAt(9 * Math.cos(i), 9 * Math.sin(i));
      expect(Math.hypot(ahead, left)).toBeLessThanOrEqual(1.0001);
    }
  });

  it("knows nine keys; the middle one, and opposite ones, stand", () => {
    expect(pushOf(new Set(["KeyI"]))).toEqual([1, 0]);
    expect(pushOf(new Set(["KeyU"]))).toEqual([1, 1]);
    expect(pushOf(new Set(["Numpad3"]))).toEqual([-1, -1]);
    expect(pushOf(new Set(["KeyI", "KeyJ"]))).toEqual([1, 1]);
    expect(pushOf(new Set(["KeyI", "KeyK"]))).toBeNull();
    expect(pushOf(new Set(["KeyI", "Comma"]))).toBeNull();
    expect(pushOf(new Set())).toBeNull();
  });

  it("hears a gamepad only while a button at its shoulder is held", () => {
    const held = [false, false, false, false, true];
    expect(pushOfPad([0, -1], [])).toBeNull();
    expect(pushOfPad([0, -1], held)).toEqual([1, -0]);
    expect(pushOfPad([0.5, 0], held)).toEqual([-0, -0.5]);
    expect(pushOfPad([0.05, 0.05], held)).toBeNull();
  });
});
