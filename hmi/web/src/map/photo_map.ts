import Feature from "ol/Feature";
import OlMap from "ol/Map";
import View from "ol/View";
import { Point } from "ol/geom";
import { defaults as interactionDefaults } from "ol/interaction";
import TileLayer from "ol/layer/Tile";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import XYZ from "ol/source/XYZ";
import type { TileInfo } from "../api_types";
import { inkOf } from "./drawing_image";
import type { Extent, XY } from "./geometry";
import { fromLatLon, tileMiddle, tileResolution } from "./mercator";
import type { Similarity } from "./similarity";
import { sketch } from "./styles";
import { theme } from "./theme";

/** Seen on roofs, grass and asphalt alike. */
const kOverlayInk = [255, 235, 59] as const;

/** What a person asked photographs of: the first view. */
export interface PhotoPlace {
  latitude: number;
  longitude: number;
  radius_m: number;
}

/** The aerial photographs that were saved with the site, and the drawing laid over them. Web Mercator. */
export class PhotoMap {
  readonly map: OlMap;
  private readonly marks = new VectorSource();
  private readonly canvas = document.createElement("canvas");
  private ink: HTMLCanvasElement | null = null;
  private width_px = 1;
  private placed: Similarity | null = null;
  private readonly unwatch: () => void;

  constructor(target: HTMLElement, private readonly info: TileInfo, near: PhotoPlace | null) {
    const saved = new Set(info.tiles.map(([x, y]) => `${x}/${y}`));
    const tileUrlFunction = ([z, x, y]: number[]) => (saved.has(`${x}/${y}`) ? `/api/site/tiles/${z}/${x}/${y}` : undefined);
    const source = new XYZ({ tileUrlFunction, minZoom: info.zoom, maxZoom: info.zoom, tileSize: info.tile_px, transition: 0 });
    const view = new View({ minResolution: this.nativeResolution / 64, maxResolution: this.nativeResolution * 8, constrainResolution: false });
    this.map = new OlMap({
      target,
      controls: [],
      pixelRatio: 1,
      interactions: interactionDefaults({ altShiftDragRotate: false, pinchRotate: false, doubleClickZoom: false }),
      layers: [new TileLayer({ source }), new VectorLayer({ source: this.marks, style: sketch })],
      view,
    });
    view.setCenter(this.middle);
    view.setResolution(this.nativeResolution);
    const show = () => view.fit(near ? this.around(near) : this.extent);
    if (this.map.getSize()) show();
    else this.map.once("change:size", show);
    this.canvas.className = "live-overlay";
    (this.map.getViewport() as HTMLElement).append(this.canvas);
    this.map.on("postrender", () => this.draw());
    Object.assign(target, { olMap: this.map }); // so that a test can ask where a place is on the screen
    this.unwatch = theme.watch(() => this.marks.changed());
  }

  dispose(): void {
    this.unwatch();
    this.map.setTarget(undefined);
    this.map.dispose();
  }

  get nativeResolution(): number {
    return tileResolution(this.info.zoom, this.info.tile_px);
  }

  private around({ latitude, longitude, radius_m }: PhotoPlace): Extent {
    const [x, y] = fromLatLon(latitude, longitude);
    const reach = radius_m / Math.cos((latitude * Math.PI) / 180);
    return [x - reach, y - reach, x + reach, y + reach];
  }

  /** Of all photographs: whatever a person looks for is in the first view. */
  private get extent(): Extent {
    const side = tileResolution(this.info.zoom, 1);
    const half = side * 2 ** (this.info.zoom - 1);
    const columns = this.info.tiles.map((tile) => tile[0] ?? 0);
    const rows = this.info.tiles.map((tile) => tile[1] ?? 0);
    const [left, top] = [Math.min(...columns), Math.min(...rows)];
    return [left * side - half, half - (Math.max(...rows) + 1) * side, (Math.max(...columns) + 1) * side - half, half - top * side];
  }

  get middle(): XY {
    const { latitude_deg, longitude_deg, tiles, zoom } = this.info;
    if (typeof latitude_deg === "number" && typeof longitude_deg === "number") return fromLatLon(latitude_deg, longitude_deg);
    const mean = (axis: 0 | 1) => tiles.reduce((sum, tile) => sum + (tile[axis] ?? 0), 0) / Math.max(1, tiles.length);
    const [x, y] = [mean(0), mean(1)];
    const { latitude, longitude } = tileMiddle(zoom, x, y);
    return fromLatLon(latitude, longitude);
  }

  zoom(steps: number): void {
    const view = this.map.getView();
    view.animate({ resolution: (view.getResolution() ?? 1) / 2 ** steps, duration: 120 });
  }

  show(points: readonly { latitude: number; longitude: number; label: string; outlier: boolean }[]): void {
    this.marks.clear(true);
    for (const { latitude, longitude, label, outlier } of points) {
      const feature = new Feature(new Point(fromLatLon(latitude, longitude)));
      feature.setProperties({ label, outlier });
      this.marks.addFeature(feature);
    }
  }

  async loadDrawing(url: string, width_px: number): Promise<void> {
    this.ink = await inkOf(url, kOverlayInk);
    this.width_px = width_px;
    this.map.getTargetElement()?.setAttribute("data-drawing", "shown");
    this.draw();
  }

  /** Takes (u, -v) of the drawing to Mercator metres. */
  place(placed: Similarity): void {
    this.placed = placed;
    this.draw();
  }

  private draw(): void {
    const [width = 0, height = 0] = this.map.getSize() ?? [];
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const context = this.canvas.getContext("2d");
    const [cx = 0, cy = 0] = this.map.getView().getCenter() ?? [];
    const resolution = this.map.getView().getResolution() ?? 1;
    context?.setTransform(1, 0, 0, 1, 0, 0);
    context?.clearRect(0, 0, width, height);
    if (!context || !this.ink || !this.placed) return;
    const { a, b, tx, ty } = this.placed;
    const k = this.width_px / this.ink.width / resolution;
    context.setTransform(a * k, -b * k, b * k, a * k, (tx - cx) / resolution + width / 2, (cy - ty) / resolution + height / 2);
    context.fillStyle = "rgba(0, 0, 0, 0.35)";
    context.fillRect(0, 0, this.ink.width, this.ink.height);
    context.imageSmoothingQuality = "high";  // thin lines of a drawing that is shown small
    context.drawImage(this.ink, 0, 0);
  }
}
