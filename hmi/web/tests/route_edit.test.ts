import { describe, expect, it } from "vitest";
import { draw, freeName, headingTo, neighbours, nodeAt, remove, setWays, waysOf, type RoutePlan } from "../src/pages/setup/route_edit";

const empty: RoutePlan = { nodes: [], legs: [] };

describe("drawing routes", () => {
  it("sets points one after the other and joins them both ways", () => {
    const first = draw(empty, null, [1, 2], 0.5);
    const second = draw(first.plan, first.node, [5, 2], 0.5);
    expect(second.plan.nodes.map((n) => [n.id, n.x, n.y])).toEqual([[0, 1, 2], [1, 5, 2]]);
    expect(second.plan.legs).toEqual([[0, 1], [1, 0]]);
  });

  it("snaps to a point that is near, and joins it once", () => {
    let plan = draw(draw(empty, null, [0, 0], 0.5).plan, 0, [4, 0], 0.5).plan;
    const closed = draw(plan, 1, [0.3, 0.3], 0.5);
    expect(closed.node).toBe(0);
    expect(closed.plan.nodes).toHaveLength(2);
    expect(closed.plan.legs).toHaveLength(2);
    plan = closed.plan;
    expect(nodeAt(plan, [4.2, 0.1], 0.5)?.id).toBe(1);
    expect(nodeAt(plan, [2, 0], 0.5)).toBeUndefined();
  });

  it("removes a point with its legs, and numbers new ones freshly", () => {
    const plan = draw(draw(empty, null, [0, 0], 0.5).plan, 0, [4, 0], 0.5).plan;
    const left = remove(plan, 0);
    expect(left.legs).toEqual([]);
    expect(draw(left, null, [9, 9], 0.5).node).toBe(2);
  });

  it("does not give the number of a removed point again", () => {
    const plan = draw(draw(empty, null, [0, 0], 0.5).plan, 0, [4, 0], 0.5).plan;
    const left = remove(plan, 1);
    const anew = draw(left, null, [9, 9], 0.5);
    expect(anew.node).toBe(2);
    expect(draw(remove(anew.plan, 2), null, [8, 8], 0.5).node).toBe(3);
  });

  it("makes a leg one-way and two-way again", () => {
    const plan = draw(draw(empty, null, [0, 0], 0.5).plan, 0, [4, 0], 0.5).plan;
    for (const [ways, legs] of [["out", [[0, 1]]], ["in", [[1, 0]]], ["both", [[0, 1], [1, 0]]]] as const) {
      const set = setWays(plan, 0, 1, ways);
      expect(set.legs).toEqual(legs);
      expect(waysOf(set, 0, 1)).toBe(ways);
    }
  });

  it("branches off a leg: the new point lies on it, and its directions stay", () => {
    const oneWay = setWays(draw(draw(empty, null, [0, 0], 0.5).plan, 0, [4, 0], 0.5).plan, 0, 1, "out");
    const branched = draw(oneWay, null, [2, 0.3], 0.5);
    expect(branched.node).toBe(2);
    expect(branched.plan.nodes[2]).toMatchObject({ x: 2, y: 0 });
    expect(branched.plan.legs).toEqual([[0, 2], [2, 1]]);
    expect(neighbours(branched.plan, 2).sort()).toEqual([0, 1]);
  });

  it("finds a free name and a heading", () => {
    const plan = { nodes: [{ ...draw(empty, null, [0, 0], 1).plan.nodes[0]!, name: "Dock 1" }], legs: [] };
    expect(freeName(plan, "Dock")).toBe("Dock 2");
    expect(freeName(plan, "Press")).toBe("Press 1");
    expect(headingTo(plan.nodes[0]!, [-1, 1])).toBe(135);
  });
});
