import type { RouteNode, Routes } from "../../api_types";
import { nearest, type XY } from "../../map/geometry";

export type RoutePlan = Pick<Routes, "nodes" | "legs">;

const freeId = (nodes: readonly RouteNode[]) => nodes.reduce((most, node) => Math.max(most, node.id), -1) + 1;
const same = (leg: readonly number[], from: number, to: number) => leg[0] === from && leg[1] === to;

/** The node within `reach` of a place; undefined where none is. */
export function nodeAt(plan: RoutePlan, at: XY, reach: number): RouteNode | undefined {
  return plan.nodes[nearest(plan.nodes.map((node) => [node.x, node.y] as XY), at, reach)];
}

/** Joins the last node to the node at a place, which is made where none is near. */
export function draw(plan: RoutePlan, last: number | null, at: XY, reach: number): { plan: RoutePlan; node: number } {
  const old = nodeAt(plan, at, reach);
  const node: RouteNode = old ?? {
    id: freeId(plan.nodes), x: at[0], y: at[1], name: "", station: false, heading_deg: null, speed_mps: null, action: "",
  };
  const nodes = old ? plan.nodes : [...plan.nodes, node];
  const legs = [...plan.legs];
  if (last !== null && last !== node.id) {
    for (const [from, to] of [[last, node.id], [node.id, last]] as [number, number][])
      if (!legs.some((leg) => same(leg, from, to))) legs.push([from, to]);
  }
  return { plan: { nodes, legs }, node: node.id };
}

export function remove(plan: RoutePlan, id: number): RoutePlan {
  return { nodes: plan.nodes.filter((node) => node.id !== id), legs: plan.legs.filter(([from, to]) => from !== id && to !== id) };
}

export function update(plan: RoutePlan, changed: RouteNode): RoutePlan {
  return { ...plan, nodes: plan.nodes.map((node) => (node.id === changed.id ? changed : node)) };
}

/** Leaves only the way from -> to, or both ways again. */
export function setOneWay(plan: RoutePlan, from: number, to: number, oneWay: boolean): RoutePlan {
  const legs = plan.legs.filter((leg) => !same(leg, to, from));
  return { ...plan, legs: oneWay ? legs : [...legs, [to, from]] };
}
