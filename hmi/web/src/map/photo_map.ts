import Feature from "ol/Feature";
import OlMap from "ol/Map";
import View from "ol/View";
import { Point } from "ol/geom";
import { defaults as interactionDefaults } from "ol/interaction";
import TileLayer from "ol/layer/Tile";
import VectorLayer from "ol/layer/Vector";
import { fromLonLat, toLonLat } from "ol/proj";
import VectorSource from "ol/source/Vector";
import XYZ from "ol/source/XYZ";
import type { TileInfo } from "../api_types";
import { sketch } from "./styles";

/** The middle of tile x, y at a zoom, degrees (Web Mercator). */
export function tileMiddle(zoom: number, x: number, y: number): { latitude: number; longitude: number } {
  const n = 2 ** zoom;
  const latitude = (180 / Math.PI) * Math.atan(Math.sinh(Math.PI * (1 - (2 * (y + 0.5)) / n)));
  return { latitude, longitude: ((x + 0.5) / n) * 360 - 180 };
}

/** The aerial photographs that were saved with the site. */
export class PhotoMap {
  readonly map: OlMap;
  private readonly marks = new VectorSource();

  constructor(target: HTMLElement, info: TileInfo, tapped: (latitude: number, longitude: number) => void) {
    const source = new XYZ({
      url: "/api/site/tiles/{z}/{x}/{y}",
      minZoom: info.zoom,
      maxZoom: info.zoom,
      attributions: info.attribution,
    });
    const middle = info.tiles[Math.floor(info.tiles.length / 2)] ?? [0, 0];
    const { latitude, longitude } = tileMiddle(info.zoom, middle[0] ?? 0, middle[1] ?? 0);
    this.map = new OlMap({
      target,
      controls: [],
      interactions: interactionDefaults({ altShiftDragRotate: false, pinchRotate: false }),
      layers: [new TileLayer({ source }), new VectorLayer({ source: this.marks, style: sketch })],
      view: new View({ center: fromLonLat([longitude, latitude]), zoom: info.zoom, minZoom: info.zoom - 2, maxZoom: info.zoom + 5 }),
    });
    this.map.on("click", (event) => {
      const [lon = 0, lat = 0] = toLonLat(event.coordinate);
      tapped(lat, lon);
    });
  }

  show(points: readonly { latitude: number; longitude: number; label: string; outlier: boolean }[]): void {
    this.marks.clear(true);
    for (const { latitude, longitude, label, outlier } of points) {
      const feature = new Feature(new Point(fromLonLat([longitude, latitude])));
      feature.setProperties({ label, outlier });
      this.marks.addFeature(feature);
    }
  }

  dispose(): void {
    this.map.setTarget(undefined);
    this.map.dispose();
  }
}
