import type { FeatureLike } from "ol/Feature";
import { LineString, Point } from "ol/geom";
import { Circle, Fill, RegularShape, Stroke, Style, Text } from "ol/style";
import type { RouteNode } from "../api_types";
import { palette } from "./theme";

const kFont = "600 17px system-ui, 'DejaVu Sans', 'Noto Sans CJK JP', sans-serif";

export function wall(): Style {
  return new Style({ stroke: new Stroke({ color: palette().ink, width: 2 }) });
}

/** Reliability by width and dashes as well as by colour: confirmed walls are bold, missing ones dotted, displaced ones broken. */
export function seen(feature: FeatureLike): Style[] {
  const { ink, amber, paper } = palette();
  const state = feature.get("state") as string;
  if (state === "confirmed") return [new Style({ stroke: new Stroke({ color: ink, width: 5 }) })];
  const lineDash = state === "missing" ? [4, 8] : [10, 5];
  return [
    new Style({ stroke: new Stroke({ color: paper, width: 4, lineCap: "butt" }) }),
    new Style({ stroke: new Stroke({ color: amber, width: 4, lineDash, lineCap: "butt" }) }),
  ];
}

function arrow(feature: FeatureLike): Style {
  const line = feature.getGeometry() as LineString;
  const [ax = 0, ay = 0] = line.getFirstCoordinate();
  const [bx = 0, by = 0] = line.getLastCoordinate();
  return new Style({
    geometry: new Point([(ax + bx) / 2, (ay + by) / 2]),
    image: new RegularShape({
      points: 3, radius: 11, declutterMode: "none", rotation: Math.atan2(bx - ax, by - ay), rotateWithView: true,
      fill: new Fill({ color: palette().ink }),
    }),
  });
}

const text = (words: string, offsetY: number, color: string) =>
  new Text({ text: words, offsetY, font: kFont, fill: new Fill({ color }), stroke: new Stroke({ color: palette().paper, width: 5 }) });

const nodeName = (node: RouteNode) => (node.name === "" ? String(node.id) : node.name);

/** The heading of a stop as a pointer beside it. */
function heading(degrees: number): Style {
  const angle = (degrees * Math.PI) / 180;
  return new Style({
    image: new RegularShape({
      points: 3, radius: 9, declutterMode: "none", rotation: Math.PI / 2 - angle, displacement: [0, 24],
      fill: new Fill({ color: palette().ink }),
    }),
  });
}

/** Of names that would lie on one another the map shows one; points and legs all (`declutterMode`). */
export function route(feature: FeatureLike): Style | Style[] {
  const { ink, paper, grey, blue, red } = palette();
  if (feature.get("kind") === "leg") {
    const faulty = feature.get("faulty") as boolean;
    const line = new Style({ stroke: new Stroke({ color: faulty ? red : grey, width: faulty ? 8 : 5, lineDash: faulty ? [14, 8] : undefined, lineCap: "butt" }) });
    return feature.get("oneWay") ? [line, arrow(feature)] : line;
  }
  const node = feature.get("node") as RouteNode;
  const chosen = feature.get("chosen") as boolean;
  const stroke = new Stroke({ color: chosen ? blue : feature.get("faulty") ? red : ink, width: chosen ? 6 : 3 });
  const fill = new Fill({ color: paper });
  const image = node.station
    ? new RegularShape({ points: 4, radius: chosen ? 19 : 15, angle: Math.PI / 4, stroke, fill, declutterMode: "none" })
    : new Circle({ radius: chosen ? 12 : 8, stroke, fill, declutterMode: "none" });
  const words = node.station || node.name !== "" ? text(nodeName(node), -28, ink) : undefined;
  const dot = new Style({ image, text: words, zIndex: chosen ? 1 : 0 });  // the name of the chosen one first
  return node.heading_deg === null ? dot : [dot, heading(node.heading_deg)];
}

/** What a page draws itself: measured lines, points of a pair. */
export function sketch(feature: FeatureLike): Style[] {
  const { paper, blue, red } = palette();
  const label = feature.get("label") as string | undefined;
  const color = feature.get("outlier") ? red : blue;
  const geometry = feature.getGeometry();
  if (feature.get("contradicted")) return [new Style({ stroke: new Stroke({ color: paper, width: 9 }) }), new Style({ stroke: new Stroke({ color: red, width: 6, lineDash: [6, 6], lineCap: "butt" }) })];
  const dot = new Circle({ radius: 8, stroke: new Stroke({ color, width: 4 }), fill: new Fill({ color: paper }) });
  const styles = [new Style({ stroke: new Stroke({ color, width: 4 }), image: dot, text: label ? text(label, -22, color) : undefined })];
  if (geometry instanceof LineString)
    for (const end of geometry.getCoordinates()) styles.push(new Style({ geometry: new Point(end), image: dot }));
  return styles;
}
