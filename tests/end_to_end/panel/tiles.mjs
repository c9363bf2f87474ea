// A tile server with an aerial photograph of a known building: its walls drawn at their true place on Earth.
import { createServer } from "node:http";
import { png } from "./png.mjs";

const kTile = 256;
const kEarth_m = 6378137;

/** Mercator pixels of a whole-world picture at a zoom, v down. */
export function worldPixel(latitude, longitude, zoom) {
  const size = kTile * 2 ** zoom;
  const y = Math.log(Math.tan(Math.PI / 4 + (latitude * Math.PI) / 360));
  return [((longitude + 180) / 360) * size, ((1 - y / Math.PI) / 2) * size];
}

/** A place `east_m`, `north_m` of an origin on the WGS84 ellipsoid (local plane; good to millimetres within 100 m). */
export function placeOf({ latitude, longitude }, east_m, north_m) {
  const a = 6378137;
  const e2 = 0.00669437999014;
  const s = Math.sin((latitude * Math.PI) / 180);
  const w = Math.sqrt(1 - e2 * s * s);
  const meridian = (a * (1 - e2)) / w ** 3;
  const normal = a / w;
  return {
    latitude: latitude + ((north_m / meridian) * 180) / Math.PI,
    longitude: longitude + ((east_m / (normal * Math.cos((latitude * Math.PI) / 180))) * 180) / Math.PI,
  };
}

export const mercator = ({ latitude, longitude }) => [
  (kEarth_m * longitude * Math.PI) / 180,
  kEarth_m * Math.log(Math.tan(Math.PI / 4 + (latitude * Math.PI) / 360)),
];

function drawTile(x, y, zoom, lines) {
  const grey = new Uint8Array(kTile * kTile).fill(110);
  for (const [a, b] of lines) {
    const steps = Math.ceil(2 * Math.hypot(b[0] - a[0], b[1] - a[1]));
    for (let i = 0; i <= steps; ++i) {
      const u = Math.floor(a[0] + ((b[0] - a[0]) * i) / steps - x * kTile);
      const v = Math.floor(a[1] + ((b[1] - a[1]) * i) / steps - y * kTile);
      if (u >= 0 && v >= 0 && u < kTile && v < kTile) grey[v * kTile + u] = 235;
    }
  }
  return png(kTile, kTile, grey);
}

/** Serves /Z/X/Y.png; `walls`: pairs of {latitude, longitude}. */
export function serveTiles(walls) {
  const server = createServer((request, answer) => {
    const match = request.url.match(/^\/(\d+)\/(\d+)\/(\d+)\.png$/);
    if (!match) return answer.writeHead(404).end();
    const [zoom, x, y] = match.slice(1).map(Number);
    const lines = walls.map((ends) => ends.map((end) => worldPixel(end.latitude, end.longitude, zoom)));
    answer.writeHead(200, { "Content-Type": "image/png" }).end(drawTile(x, y, zoom, lines));
  });
  return new Promise((done) => server.listen(0, "127.0.0.1", () => done({ url: `http://127.0.0.1:${server.address().port}/{z}/{x}/{y}.png`, close: () => server.close() })));
}
