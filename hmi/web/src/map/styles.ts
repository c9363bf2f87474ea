import type { FeatureLike } from "ol/Feature";
import type { LineString } from "ol/geom";
import { Point } from "ol/geom";
import { Circle, Fill, RegularShape, Stroke, Style, Text } from "ol/style";
import type { RouteNode } from "../api_types";

const dark = () => document.documentElement.dataset.theme === "dark";
const ink = () => (dark() ? "#e4e4e4" : "#222222");
const paper = () => (dark() ? "#202224" : "#f2f2f2");
const amber = "#c77700";
const red = "#c62828";

/** Reliability by width and dashes as well as by colour: confirmed walls are bold, missed ones thin and broken. */
export function wall(feature: FeatureLike): Style {
  const reliability = feature.get("reliability") as number;
  if (feature.get("chosen")) return new Style({ stroke: new Stroke({ color: red, width: 6 }) });
  if (reliability < 0) return new Style({ stroke: new Stroke({ color: ink(), width: 2 }) });
  if (reliability < 0.3) return new Style({ stroke: new Stroke({ color: amber, width: 1.5, lineDash: [3, 6] }) });
  if (reliability < 0.7) return new Style({ stroke: new Stroke({ color: ink(), width: 1.5, lineDash: [8, 4] }) });
  return new Style({ stroke: new Stroke({ color: ink(), width: 3 }) });
}

function arrow(feature: FeatureLike): Style {
  const line = feature.getGeometry() as LineString;
  const [ax = 0, ay = 0] = line.getFirstCoordinate();
  const [bx = 0, by = 0] = line.getLastCoordinate();
  return new Style({
    geometry: new Point([(ax + bx) / 2, (ay + by) / 2]),
    image: new RegularShape({
      points: 3, radius: 11, rotation: Math.atan2(bx - ax, by - ay), rotateWithView: true,
      fill: new Fill({ color: ink() }),
    }),
  });
}

function label(node: RouteNode): string {
  return node.name === "" ? String(node.id) : node.name;
}

export function route(feature: FeatureLike): Style | Style[] {
  if (feature.get("kind") === "leg") {
    const line = new Style({ stroke: new Stroke({ color: dark() ? "#9aa0a6" : "#5f6368", width: 4 }) });
    return feature.get("oneWay") ? [line, arrow(feature)] : line;
  }
  const node = feature.get("node") as RouteNode;
  const stroke = new Stroke({ color: feature.get("chosen") ? red : ink(), width: feature.get("chosen") ? 5 : 3 });
  const fill = new Fill({ color: paper() });
  const image = node.station
    ? new RegularShape({ points: 4, radius: 15, angle: Math.PI / 4, stroke, fill })
    : new Circle({ radius: 8, stroke, fill });
  const text = node.station || node.name !== ""
    ? new Text({
        text: label(node), offsetY: -26, font: "600 16px system-ui, sans-serif", fill: new Fill({ color: ink() }),
        stroke: new Stroke({ color: paper(), width: 4 }),
      })
    : undefined;
  return new Style({ image, text });
}

const healthFill: Record<string, string> = { LOCALIZED: "#3c4043cc", DEGRADED: `${amber}cc`, AMBIGUOUS: `${amber}cc`, LOST: `${red}cc` };

export function live(feature: FeatureLike): Style {
  const health = feature.get("health") as string;
  switch (feature.get("kind")) {
    case "path":
      return new Style({ stroke: new Stroke({ color: ink(), width: 5, lineDash: [12, 8] }) });
    case "blocked":
      return new Style({ image: new RegularShape({ points: 4, radius: 12, radius2: 3, angle: Math.PI / 4, fill: new Fill({ color: red }) }) });
    case "particle":
      return new Style({ image: new Circle({ radius: 2, fill: new Fill({ color: dark() ? "#9aa0a6" : "#70757a" }) }) });
    case "marker": // always large enough to be seen, pointing where the vehicle points
      return new Style({
        image: new RegularShape({
          points: 3, radius: 16, scale: [0.75, 1], rotation: Math.PI / 2 - (feature.get("yaw") as number), rotateWithView: true,
          fill: new Fill({ color: healthFill[health] ?? "#3c4043cc" }), stroke: new Stroke({ color: paper(), width: 3 }),
        }),
      });
    case "uncertainty":
      return new Style({ stroke: new Stroke({ color: ink(), width: 2, lineDash: [4, 4] }) });
    default:
      return new Style({
        fill: new Fill({ color: healthFill[health] ?? "#3c4043cc" }),
        stroke: new Stroke({ color: paper(), width: 2 }),
      });
  }
}

export function sketch(feature: FeatureLike): Style {
  const text = feature.get("label") as string | undefined;
  const colour = feature.get("outlier") ? red : (dark() ? "#8ab4f8" : "#174ea6");
  return new Style({
    stroke: new Stroke({ color: colour, width: 4 }),
    image: new Circle({ radius: 9, stroke: new Stroke({ color: colour, width: 4 }), fill: new Fill({ color: paper() }) }),
    text: text
      ? new Text({ text, offsetY: -22, font: "600 16px system-ui, sans-serif", fill: new Fill({ color: colour }), stroke: new Stroke({ color: paper(), width: 4 }) })
      : undefined,
  });
}
