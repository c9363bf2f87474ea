import Feature from "ol/Feature";
import OlMap from "ol/Map";
import View from "ol/View";
import { LineString, Point } from "ol/geom";
import ImageLayer from "ol/layer/Image";
import VectorLayer from "ol/layer/Vector";
import { createEmpty, extend } from "ol/extent";
import { Projection } from "ol/proj";
import ImageCanvas from "ol/source/ImageCanvas";
import VectorSource from "ol/source/Vector";
import { defaults as interactionDefaults } from "ol/interaction";
import type { Routes, Site, WallPiece } from "../api_types";
import { inkOf } from "./drawing_image";
import { extentOf, type Extent, type XY } from "./geometry";
import { LiveOverlay } from "./live_overlay";
import * as styles from "./styles";
import { palette, theme } from "./theme";

/** Metres, x right and y up: the Map frame itself, no Earth involved. */
export function mapProjection(extent: Extent): Projection {
  return new Projection({ code: "MADORI", units: "m", extent, metersPerUnit: 1 });
}

/** Draws a picture that covers `all` into the part of it that a map shows. */
function pictureSource(picture: HTMLCanvasElement, all: Extent, projection: Projection): ImageCanvas {
  return new ImageCanvas({
    projection,
    ratio: 1,
    interpolate: true,
    canvasFunction: (extent, resolution, _ratio, size) => {
      const [x0 = 0, , , y1 = 0] = extent;
      const canvas = document.createElement("canvas");
      canvas.width = Math.ceil(size[0] ?? 1);
      canvas.height = Math.ceil(size[1] ?? 1);
      const perUnit = (size[0] ?? 1) / ((extent[2] ?? 1) - x0);
      const context = canvas.getContext("2d");
      if (context) context.imageSmoothingQuality = resolution > 0 ? "medium" : "low";
      context?.drawImage(picture, (all[0] - x0) * perUnit, (y1 - all[3]) * perUnit, (all[2] - all[0]) * perUnit, (all[3] - all[1]) * perUnit);
      return canvas;
    },
  });
}

/** Of a map whose size nobody knows yet. */
const growing = mapProjection([-2000, -2000, 2000, 2000]);

/** Points, two pixels wide, drawn into the part of them that a map shows. */
function pointSource(points: Float32Array): ImageCanvas {
  return new ImageCanvas({
    projection: growing,
    ratio: 1,
    canvasFunction: (extent, _resolution, _ratio, size) => {
      const [x0 = 0, , x1 = 1, y1 = 0] = extent;
      const canvas = document.createElement("canvas");
      canvas.width = Math.ceil(size[0] ?? 1);
      canvas.height = Math.ceil(size[1] ?? 1);
      const perUnit = (size[0] ?? 1) / (x1 - x0);
      const context = canvas.getContext("2d");
      if (!context) return canvas;
      context.fillStyle = palette().grey;
      for (let i = 0; i + 1 < points.length; i += 2) context.fillRect(((points[i] ?? 0) - x0) * perUnit, (y1 - (points[i + 1] ?? 0)) * perUnit, 2, 2);
      return canvas;
    },
  });
}

/** The picture of the factory that all pages share. Layers from the bottom: drawing, walls, routes, sketch; above them what moves. */
export class FactoryMap {
  readonly map: OlMap;
  readonly walls = new VectorSource();
  private readonly seen = new VectorSource();
  readonly routes = new VectorSource();
  /** for what a page draws itself */
  readonly sketch = new VectorSource();
  readonly live: LiveOverlay;
  private readonly seenPoints = new ImageLayer<ImageCanvas>();
  private readonly drawing = new ImageLayer<ImageCanvas>({ opacity: 0.45 });
  private extent: Extent = [0, 0, 10, 10];
  /** left free around walls and drawing, the buttons below included; pixels: top, right, bottom, left */
  room = [28, 20, 100, 20];
  /** the last view that was not chosen by a finger: held when the map is given another size */
  private view: (() => void) | null = null;
  private drawn: { url: string; projection: Projection } | null = null;
  private readonly unwatch: () => void;

  constructor(target: HTMLElement) {
    const layer = (source: VectorSource, style: (typeof styles)["seen" | "sketch"] | typeof styles.wall) => new VectorLayer({ source, style: style as never });
    this.map = new OlMap({
      target,
      controls: [],
      pixelRatio: 1,
      interactions: interactionDefaults({ altShiftDragRotate: false, pinchRotate: false, doubleClickZoom: false }),
      layers: [this.drawing, this.seenPoints, layer(this.walls, styles.wall), layer(this.seen, styles.seen), new VectorLayer({ source: this.routes, style: styles.route, declutter: true }), layer(this.sketch, styles.sketch)],
      view: new View({ projection: mapProjection([0, 0, 10, 10]), center: [5, 5], resolution: 0.1 }),
    });
    this.live = new LiveOverlay(this.map);
    this.map.on("change:size", () => this.view?.());
    const viewport = this.map.getViewport() as HTMLElement;
    for (const gesture of ["pointermove", "wheel"]) viewport.addEventListener(gesture, (event) => this.moved(event), { passive: true });
    Object.assign(target, { olMap: this.map }); // so that a test can ask where a place is on the screen
    this.unwatch = theme.watch(() => {
      for (const each of this.map.getLayers().getArray()) each.changed();
      this.showDrawing();
    });
  }

  dispose(): void {
    this.unwatch();
    this.map.setTarget(undefined);
    this.map.dispose();
  }

  /** Shows the drawing of a site and fits it into the view. */
  showSite(site: Site, drawingUrl: string | null): void {
    if (!site.drawing) return;
    const unit = site.scale?.m_per_px ?? 1;
    this.extent = extentOf(site.drawing.width_px * unit, site.drawing.height_px * unit);
    const projection = mapProjection(this.extent);
    this.drawn = drawingUrl ? { url: drawingUrl, projection } : null;
    this.map.setView(new View({ projection, showFullExtent: true, constrainOnlyCenter: true, extent: this.extent }));
    this.showDrawing();
    this.fit();
  }

  private showDrawing(): void {
    const wanted = this.drawn;
    if (!wanted) return this.drawing.setSource(null);
    const target = this.map.getTargetElement();
    target?.setAttribute("data-drawing", "coming");  // so that a test can wait for it
    void inkOf(wanted.url, palette().rgb).then(
      (ink) => {
        if (this.drawn !== wanted) return;
        this.drawing.setSource(pictureSource(ink, this.extent, wanted.projection));
        target?.setAttribute("data-drawing", "shown");
      },
      () => undefined, // the walls are shown all the same
    );
  }

  /** No drawing: a map that grows around its origin. */
  showGrowing(): void {
    this.map.setView(new View({ projection: growing, center: [0, 0], resolution: 0.02 }));
    this.extent = [-4, -4, 4, 4];
    this.fit();
  }

  /** What was seen so far of a growing map: x, y pairs. */
  showPoints(points: Float32Array): void {
    let [x0, y0, x1, y1] = [-4, -4, 4, 4];
    for (let i = 0; i + 1 < points.length; i += 2) {
      const [x = 0, y = 0] = [points[i], points[i + 1]];
      [x0, y0, x1, y1] = [Math.min(x0, x), Math.min(y0, y), Math.max(x1, x), Math.max(y1, y)];
    }
    this.extent = [x0, y0, x1, y1];
    this.seenPoints.setSource(pointSource(points));
    this.map.getTargetElement()?.setAttribute("data-points", String(points.length / 2));  // so that a test can ask
    this.view?.();
  }

  /** A finger has chosen the view: only so much that the vehicle does not leave it. */
  keepInView(at: XY): void {
    if (this.view) return;
    const [width = 0, height = 0] = this.map.getSize() ?? [];
    const [u = 0, v = 0] = this.map.getPixelFromCoordinate(at) ?? [];
    if (width > 0 && (u < 0 || v < 0 || u > width || v > height)) this.map.getView().setCenter(at);
  }

  private moved(event: Event): void {
    if (event instanceof WheelEvent || (event as PointerEvent).buttons > 0) this.view = null;
  }

  fit(): void {
    this.view = () => this.map.getView().fit(this.extent, { padding: this.room });
    this.view();
  }

  /** Shows the walls, and what else is given, as large as the view allows. */
  fitWalls(also: readonly VectorSource[] = []): void {
    if (this.walls.getFeatures().length === 0) return;
    const extent = createEmpty();
    for (const source of [this.walls, ...also]) extend(extent, source.getExtent() ?? createEmpty());
    this.view = () => this.map.getView().fit(extent, { padding: this.room });
    this.view();
  }

  /** Brings a place of the map to its middle, with something around it. */
  showPlace([x0, y0, x1, y1]: Extent): void {
    this.view = null;
    const around_m = 5;
    this.map.getView().fit([x0 - around_m, y0 - around_m, x1 + around_m, y1 + around_m], { padding: this.room, duration: 300 });
  }

  zoom(steps: number): void {
    this.view = null;
    const view = this.map.getView();
    view.animate({ zoom: (view.getZoom() ?? 0) + steps, duration: 120 });
  }

  /** x1, y1, x2, y2, whatever follows is left alone */
  showWalls(walls: readonly number[][]): void {
    this.walls.clear(true);
    this.walls.addFeatures(walls.map(([x1 = 0, y1 = 0, x2 = 0, y2 = 0]) => new Feature(new LineString([[x1, y1], [x2, y2]]))));
  }

  /** What the lidar has seen of the walls, over them; pieces that it never saw stay as they are. */
  showSeen(pieces: readonly WallPiece[]): void {
    this.seen.clear(true);
    for (const { segment, state, share } of pieces) {
      if (state === "unseen") continue;
      const [x1 = 0, y1 = 0, x2 = 0, y2 = 0] = segment;
      const feature = new Feature(new LineString([[x1, y1], [x2, y2]]));
      feature.setProperties({ state, share });
      this.seen.addFeature(feature);
    }
  }

  /** `faulty`: what a check found, marked on the legs ("from>to") and points (their ID) that it names. */
  showRoutes(routes: Pick<Routes, "nodes" | "legs">, chosen: readonly number[] = [], faulty: ReadonlySet<string> = new Set()): void {
    this.routes.clear(true);
    this.map.getTargetElement()?.setAttribute("data-faulty", [...faulty].join(" "));  // so that a test can ask
    const at = new Map(routes.nodes.map((node) => [node.id, [node.x, node.y] as XY]));
    const has = new Set(routes.legs.map(([from, to]) => `${from}>${to}`));
    for (const [from, to] of routes.legs) {
      const a = at.get(from ?? -1);
      const b = at.get(to ?? -1);
      const oneWay = !has.has(`${to}>${from}`);
      if (!a || !b || (!oneWay && (from ?? 0) > (to ?? 0))) continue;
      const leg = new Feature(new LineString([a, b]));
      leg.setProperties({ kind: "leg", oneWay, from, to, faulty: faulty.has(`${from}>${to}`) || faulty.has(`${to}>${from}`) });
      this.routes.addFeature(leg);
    }
    for (const node of routes.nodes) {
      const feature = new Feature(new Point([node.x, node.y]));
      feature.setProperties({ kind: "node", node, chosen: chosen.includes(node.id), faulty: faulty.has(String(node.id)) });
      this.routes.addFeature(feature);
    }
  }
}
