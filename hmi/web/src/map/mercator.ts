import type { XY } from "./geometry";
import { angleOf, scaleOf, type Similarity } from "./similarity";

const kRadius_m = 6378137;
const kDegree = Math.PI / 180;

export const fromLatLon = (latitude: number, longitude: number): XY => [
  kRadius_m * longitude * kDegree,
  kRadius_m * Math.log(Math.tan(Math.PI / 4 + (latitude * kDegree) / 2)),
];

export const toLatLon = ([x, y]: XY): { latitude: number; longitude: number } => ({
  latitude: (2 * Math.atan(Math.exp(y / kRadius_m)) - Math.PI / 2) / kDegree,
  longitude: x / kRadius_m / kDegree,
});

/** Mercator metres a tile pixel. */
export const tileResolution = (zoom: number, tile_px: number): number => (2 * Math.PI * kRadius_m) / tile_px / 2 ** zoom;

/** The middle of tile x, y at a zoom, degrees. */
export function tileMiddle(zoom: number, x: number, y: number): { latitude: number; longitude: number } {
  const side = tileResolution(zoom, 1);
  const half = Math.PI * kRadius_m;
  return toLatLon([(x + 0.5) * side - half, half - (y + 0.5) * side]);
}

/**
 * A drawing laid over a photograph. `placed` takes (u, -v) of the drawing to Mercator metres; Eq. (9) of the layout-map
 * paper: U = L_t / (R_t Z_p) Z_m with Z_p screen pixels a tile pixel and Z_m screen pixels a drawing pixel.
 */
export function overlayNumbers(placed: Similarity, middle_px: XY, viewResolution: number, zoom: number, tile_px: number) {
  const at: XY = [placed.a * middle_px[0] + placed.b * middle_px[1] + placed.tx, placed.b * middle_px[0] - placed.a * middle_px[1] + placed.ty];
  const { latitude, longitude } = toLatLon(at);
  return {
    latitude,
    longitude,
    rotation_deg: angleOf(placed) / kDegree,
    photo_zoom: tileResolution(zoom, tile_px) / viewResolution,
    layout_zoom: scaleOf(placed) / viewResolution,
    m_per_px: scaleOf(placed) * Math.cos(latitude * kDegree),
  };
}
