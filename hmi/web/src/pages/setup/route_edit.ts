import type { Finding, RouteNode, Routes } from "../../api_types";
import { distanceToSegment, nearest, type XY } from "../../map/geometry";

/** `next`: numbers below it were given already. A deleted one is not given again within an edit: the server would take it for a point that was moved, and orders would lead there. */
export type RoutePlan = Pick<Routes, "nodes" | "legs"> & { next?: number };
export type Ways = "both" | "out" | "in";

const freeId = ({ nodes, next = 0 }: RoutePlan) => nodes.reduce((most, node) => Math.max(most, node.id + 1), next);
const same = (leg: readonly number[], from: number, to: number) => leg[0] === from && leg[1] === to;
const has = (plan: RoutePlan, from: number, to: number) => plan.legs.some((leg) => same(leg, from, to));

/** The node within `reach` of a place; undefined where none is. */
export function nodeAt(plan: RoutePlan, at: XY, reach: number): RouteNode | undefined {
  return plan.nodes[nearest(plan.nodes.map((node) => [node.x, node.y] as XY), at, reach)];
}

const fresh = (plan: RoutePlan, [x, y]: XY): RouteNode => ({
  id: freeId(plan), x, y, name: "", station: false, heading_deg: null, speed_mps: null, action: "",
});

/** The two nodes of the leg within `reach` of a place. */
function legAt(plan: RoutePlan, at: XY, reach: number): [RouteNode, RouteNode] | undefined {
  const by = new Map(plan.nodes.map((node) => [node.id, node]));
  let found: [RouteNode, RouteNode] | undefined;
  let least = reach;
  for (const [from, to] of plan.legs) {
    const a = by.get(from ?? -1);
    const b = by.get(to ?? -1);
    if (!a || !b) continue;
    const distance = distanceToSegment(at, [a.x, a.y, b.x, b.y]);
    if (distance > least) continue;
    least = distance;
    found = [a, b];
  }
  return found;
}

/** A new node on the leg between two others, where a place is nearest to it; the leg's directions stay. */
function split(plan: RoutePlan, [a, b]: [RouteNode, RouteNode], at: XY): { plan: RoutePlan; node: RouteNode } {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const t = ((at[0] - a.x) * dx + (at[1] - a.y) * dy) / (dx * dx + dy * dy);
  const node = fresh(plan, [a.x + t * dx, a.y + t * dy]);
  const legs: RoutePlan["legs"] = plan.legs.flatMap((leg) => {
    if (same(leg, a.id, b.id)) return [[a.id, node.id], [node.id, b.id]] as RoutePlan["legs"];
    return same(leg, b.id, a.id) ? ([[b.id, node.id], [node.id, a.id]] as RoutePlan["legs"]) : [leg];
  });
  return { plan: { ...plan, nodes: [...plan.nodes, node], legs }, node };
}

/** Joins the last node to the node at a place; where none is near it is made, on a leg where one is near. */
export function draw(plan: RoutePlan, last: number | null, at: XY, reach: number): { plan: RoutePlan; node: number } {
  let base = plan;
  let node = nodeAt(plan, at, reach);
  if (!node) {
    const leg = legAt(plan, at, reach);
    if (leg) ({ plan: base, node } = split(plan, leg, at));
  }
  if (!node) {
    node = fresh(plan, at);
    base = { ...plan, nodes: [...plan.nodes, node] };
  }
  if (last === null || last === node.id) return { plan: base, node: node.id };
  const legs = [...base.legs];
  for (const [from, to] of [[last, node.id], [node.id, last]] as [number, number][])
    if (!legs.some((leg) => same(leg, from, to))) legs.push([from, to]);
  return { plan: { ...base, legs }, node: node.id };
}

export function remove(plan: RoutePlan, id: number): RoutePlan {
  return { next: Math.max(plan.next ?? 0, id + 1), nodes: plan.nodes.filter((node) => node.id !== id), legs: plan.legs.filter(([from, to]) => from !== id && to !== id) };
}

export function update(plan: RoutePlan, changed: RouteNode): RoutePlan {
  return { ...plan, nodes: plan.nodes.map((node) => (node.id === changed.id ? changed : node)) };
}

export const neighbours = (plan: RoutePlan, id: number): number[] =>
  [...new Set(plan.legs.filter((leg) => leg.includes(id)).flat())].filter((other) => other !== id);

/** Which ways the leg between two nodes may be driven, seen from the first. */
export function waysOf(plan: RoutePlan, from: number, to: number): Ways {
  if (has(plan, from, to) && has(plan, to, from)) return "both";
  return has(plan, from, to) ? "out" : "in";
}

export function setWays(plan: RoutePlan, from: number, to: number, ways: Ways): RoutePlan {
  const legs: RoutePlan["legs"] = plan.legs.filter((leg) => !same(leg, from, to) && !same(leg, to, from));
  if (ways !== "in") legs.push([from, to]);
  if (ways !== "out") legs.push([to, from]);
  return { ...plan, legs };
}

/** The first "word N" that no node is called yet. */
export function freeName(plan: RoutePlan, word: string): string {
  const taken = new Set(plan.nodes.map((node) => node.name));
  for (let number = 1; ; ++number) if (!taken.has(`${word} ${number}`)) return `${word} ${number}`;
}

/** The direction from a node to a place: whole degrees, counter-clockwise from x. */
export const headingTo = (node: RouteNode, [x, y]: XY): number => Math.round((Math.atan2(y - node.y, x - node.x) * 180) / Math.PI);

/** The legs ("from>to") and points (their ID) that errors name, as the map marks them. */
export const faultyOf = (findings: readonly Finding[]): ReadonlySet<string> =>
  new Set(findings.filter(({ severity }) => severity === "error").map(({ values }) => values["node"] ?? `${values["from"]}>${values["to"]}`));
