import { describe, expect, it } from "vitest";
import { cutOut } from "../src/map/cut_walls";
import { baseDate, daysSince } from "../src/pages/changes/day_choice";

describe("walls that are cut", () => {
  const wall = [0, 0, 10, 0, -1];

  it("become two where their middle is gone, and keep what follows the numbers", () => {
    expect(cutOut([wall], [[4, 0, 7, 0]])).toEqual([[0, 0, 4, 0, -1], [7, 0, 10, 0, -1]]);
  });

  it("lose an end, or are left out altogether", () => {
    expect(cutOut([wall], [[0, 0, 3, 0]])).toEqual([[3, 0, 10, 0, -1]]);
    expect(cutOut([wall], [[0, 0, 10, 0]])).toEqual([]);
    expect(cutOut([wall], [[10, 0, 0.01, 0]])).toEqual([]); // nothing is left that one could drive by
  });

  it("take several stretches at once, in any order and overlapping", () => {
    expect(cutOut([wall], [[8, 0, 9, 0], [2, 0, 1, 0], [1.5, 0, 3, 0]])).toEqual([[0, 0, 1, 0, -1], [3, 0, 8, 0, -1], [9, 0, 10, 0, -1]]);
  });

  it("are left alone by what lies beside, across or behind them", () => {
    for (const piece of [[4, 0.1, 7, 0.1], [5, -1, 5, 1], [5, 0, 5, 0], [11, 0, 12, 0], [8, 0, 12, 0]]) expect(cutOut([wall], [piece])).toEqual([wall]);
  });

  it("lose as much length as is gone, whichever way they run", () => {
    const length = (rows: number[][]) => rows.reduce((sum, [x1 = 0, y1 = 0, x2 = 0, y2 = 0]) => sum + Math.hypot(x2 - x1, y2 - y1), 0);
    for (let i = 0; i < 50; ++i) {
      const angle = i * 1.7;
      const at = (share: number) => [20 + 12 * share * Math.cos(angle), 30 + 12 * share * Math.sin(angle)];
      const slanted = [...at(0), ...at(1)];
      const [from, to] = [0.1 + 0.005 * i, 0.5 + 0.008 * i];
      expect(length(cutOut([slanted, wall], [[...at(to), ...at(from)]]))).toBeCloseTo(12 * (1 - (to - from)) + 10, 6);
    }
  });
});

describe("the day that is compared with", () => {
  const days = ["2026-11-02", "2026-11-16", "2026-11-18", "2026-11-24", "2026-11-25"].map((date) => ({ date, extent: [0, 0, 1, 1] as [number, number, number, number] }));

  it("is the kept one before, or the newest that is a week older, or the oldest", () => {
    expect(baseDate(days, "2026-11-25", { kind: "before" })).toBe("2026-11-24");
    expect(baseDate(days, "2026-11-25", { kind: "week" })).toBe("2026-11-18");
    expect(baseDate(days, "2026-11-24", { kind: "week" })).toBe("2026-11-16");
    expect(baseDate(days.slice(1), "2026-11-18", { kind: "week" })).toBe("2026-11-16");
    expect(baseDate(days, "2026-11-02", { kind: "week" })).toBeNull();
  });

  it("is the one that is held, also where it is the newer", () => {
    expect(baseDate(days, "2026-11-16", { kind: "held", date: "2026-11-24" })).toBe("2026-11-24");
    expect(baseDate(days, "2026-11-24", { kind: "held", date: "2026-11-24" })).toBeNull();
    expect(baseDate(days, "2026-11-24", { kind: "held", date: "2026-11-23" })).toBeNull(); // thinned meanwhile
  });

  it("is so many civil days ago", () => {
    const morning = Date.parse("2026-11-25T00:10:00Z");
    expect(daysSince("2026-11-25", morning)).toBe(0);
    expect(daysSince("2026-11-24", morning)).toBe(1);
    expect(daysSince("2026-10-25", morning)).toBe(31);
  });
});
