import Feature from "ol/Feature";
import OlMap from "ol/Map";
import View from "ol/View";
import { LineString, Point, Polygon } from "ol/geom";
import ImageLayer from "ol/layer/Image";
import VectorLayer from "ol/layer/Vector";
import { Projection } from "ol/proj";
import ImageStatic from "ol/source/ImageStatic";
import VectorSource from "ol/source/Vector";
import { defaults as interactionDefaults } from "ol/interaction";
import type { Live, Routes, Site, VehicleInfo } from "../api_types";
import { ellipseRing, extentOf, footprint, type Extent, type XY } from "./geometry";
import { pointLayer } from "./point_layer";
import * as styles from "./styles";

/** Metres, x right and y up: the Map frame itself, no Earth involved. */
export function mapProjection(extent: Extent): Projection {
  return new Projection({ code: "MADORI", units: "m", extent, metersPerUnit: 1 });
}

/** The picture of the factory that all pages share. Layers from the bottom: drawing, walls, routes, live. */
export class FactoryMap {
  readonly map: OlMap;
  readonly walls = new VectorSource();
  readonly routes = new VectorSource();
  /** for what a page draws itself */
  readonly sketch = new VectorSource();
  private readonly live = new VectorSource();
  private readonly drawing = new ImageLayer({ opacity: 0.35 });
  private readonly points = pointLayer();
  private extent: Extent = [0, 0, 10, 10];
  following = false;

  constructor(target: HTMLElement) {
    const liveLayer = new VectorLayer({ source: this.live, style: styles.live, updateWhileInteracting: true });
    this.map = new OlMap({
      target,
      controls: [],
      interactions: interactionDefaults({ altShiftDragRotate: false, pinchRotate: false }),
      layers: [
        this.drawing,
        new VectorLayer({ source: this.walls, style: styles.wall }),
        new VectorLayer({ source: this.routes, style: styles.route }),
        this.points.layer,
        liveLayer,
        new VectorLayer({ source: this.sketch, style: styles.sketch }),
      ],
      view: new View({ projection: mapProjection([0, 0, 10, 10]), center: [5, 5], resolution: 0.1 }),
    });
  }

  dispose(): void {
    this.map.setTarget(undefined);
    this.map.dispose();
  }

  /** Shows the drawing of a site and fits it into the view. */
  showSite(site: Site, drawingUrl: string | null): void {
    if (!site.drawing) return;
    const unit = site.scale?.m_per_px ?? 1;
    this.extent = extentOf(site.drawing.width_px * unit, site.drawing.height_px * unit);
    const projection = mapProjection(this.extent);
    this.drawing.setSource(
      drawingUrl ? new ImageStatic({ url: drawingUrl, imageExtent: this.extent, projection, interpolate: true }) : null,
    );
    this.map.setView(new View({ projection, showFullExtent: true, constrainOnlyCenter: true, extent: this.extent }));
    this.fit();
  }

  fit(): void {
    this.map.getView().fit(this.extent, { padding: [24, 24, 24, 24] });
  }

  zoom(steps: number): void {
    const view = this.map.getView();
    view.animate({ zoom: (view.getZoom() ?? 0) + steps, duration: 150 });
  }

  /** x1, y1, x2, y2, reliability (-1 unknown) */
  showWalls(walls: readonly number[][]): void {
    this.walls.clear(true);
    this.walls.addFeatures(
      walls.map(([x1 = 0, y1 = 0, x2 = 0, y2 = 0, reliability = -1], index) => {
        const feature = new Feature(new LineString([[x1, y1], [x2, y2]]));
        feature.setProperties({ reliability, index });
        return feature;
      }),
    );
  }

  showRoutes(routes: Pick<Routes, "nodes" | "legs">, chosen: readonly number[] = []): void {
    this.routes.clear(true);
    const at = new Map(routes.nodes.map((node) => [node.id, [node.x, node.y] as XY]));
    const has = new Set(routes.legs.map(([from, to]) => `${from}>${to}`));
    for (const [from, to] of routes.legs) {
      const a = at.get(from ?? -1);
      const b = at.get(to ?? -1);
      const oneWay = !has.has(`${to}>${from}`);
      if (!a || !b || (!oneWay && (from ?? 0) > (to ?? 0))) continue;
      const leg = new Feature(new LineString([a, b]));
      leg.setProperties({ kind: "leg", oneWay, from, to });
      this.routes.addFeature(leg);
    }
    for (const node of routes.nodes) {
      const feature = new Feature(new Point([node.x, node.y]));
      feature.setProperties({ kind: "node", node, chosen: chosen.includes(node.id) });
      this.routes.addFeature(feature);
    }
  }

  showLive(state: Live, scan: Float32Array, vehicle: VehicleInfo): void {
    this.points.show(scan);
    this.live.clear(true);
    const add = (kind: string, geometry: LineString | Polygon | Point) => {
      const feature = new Feature(geometry);
      feature.set("kind", kind);
      feature.set("health", state.pose.health);
      this.live.addFeature(feature);
    };
    if (state.path.length > 1) add("path", new LineString(state.path));
    for (const point of state.blocked) add("blocked", new Point(point));
    for (const particle of state.particles) add("particle", new Point([particle[0] ?? 0, particle[1] ?? 0]));
    const { x, y, covariance } = state.pose;
    add("uncertainty", new Polygon([ellipseRing([x, y], covariance, 2)]));
    add("vehicle", new Polygon([footprint(state.pose, vehicle)]));
    add("marker", new Point([x, y]));
    this.live.getFeatures().at(-1)?.set("yaw", state.pose.yaw);
    if (this.following) this.map.getView().setCenter([x, y]);
    this.map.render();
  }
}
