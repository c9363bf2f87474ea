// A vehicle for tests of the page alone: serves the built page and answers the API (hmi/schema/api.schema.json) with made-up
// values, a live state and 20,000 scan points ten times a second. It drives in a circle and does nothing that it is told.
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { deflateSync } from "node:zlib";
import { dayBefore, hallDay, madeUpChanges, now, then } from "./made_up_days.mjs";

const kTypes = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
const kDrawing = { file: "drawing.png", width_px: 1200, height_px: 800 };
const kScale = 0.05;
const none = { code: "", values: {}, text: "" };
const revisions = { drawing: "1", walls: "1", routes: "1", vehicle: "1" };

const walls = [[2, 2, 58, 2], [58, 2, 58, 38], [58, 38, 2, 38], [2, 38, 2, 2], [30, 2, 30, 16], [30, 22, 30, 38], [2, 26, 20, 26], [40, 20, 58, 20]];
const node = (id, x, y, name, heading_deg = null) => ({ id, x, y, name, station: name !== "", heading_deg, speed_mps: null, action: "" });
const nodes = [node(0, 8, 8, "Dock 1", 180), node(1, 20, 19, ""), node(2, 36, 19, ""), node(3, 48, 10, "Press 1", 0), node(4, 48, 30, "Store 1", 90)];
const legs = [[0, 1], [1, 0], [1, 2], [2, 1], [2, 3], [2, 4], [4, 2]];
const findings = [{ severity: "warning", file: "tree.csv", line: 4, message: "node 3 cannot be reached from the other nodes", code: "out-of-reach", values: { node: "3" } }];
const order = (id, status, stations, repeat = 1) => ({ id, stations, status, repeat, created: 1, detail: none, stops: [], round: 0, next_stop: 0 });

/** A white page with the walls on it, as the server's drawing.png. */
function drawing() {
  const { width_px: w, height_px: h } = kDrawing;
  const rows = Buffer.alloc(h * (w + 1), 255);
  for (let y = 0; y < h; ++y) rows[y * (w + 1)] = 0;
  for (const [x1, y1, x2, y2] of walls)
    for (let i = 0; i <= 2000; ++i) {
      const u = Math.round((x1 + ((x2 - x1) * i) / 2000) / kScale);
      const v = Math.round(h - (y1 + ((y2 - y1) * i) / 2000) / kScale);
      for (let d = -2; d <= 2; ++d) for (let e = -2; e <= 2; ++e) if (u + d >= 0 && u + d < w && v + e >= 0 && v + e < h) rows[(v + e) * (w + 1) + 1 + u + d] = 0;
    }
  return picture(w, h, rows);
}

const crcTable = Array.from({ length: 256 }, (_, n) => [...Array(8)].reduce((c) => (c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1), n) >>> 0);
function chunk(type, data) {
  const out = Buffer.alloc(12 + data.length);
  out.writeUInt32BE(data.length, 0);
  out.write(type, 4, "ascii");
  data.copy(out, 8);
  let crc = 0xffffffff;
  for (const byte of out.subarray(4, 8 + data.length)) crc = crcTable[(crc ^ byte) & 255] ^ (crc >>> 8);
  out.writeUInt32BE((crc ^ 0xffffffff) >>> 0, 8 + data.length);
  return out;
}
function picture(width, height, rows) {
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 0, 0, 0, 0], 8);
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk("IHDR", head), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
}

const poseAt = (t) => ({ x: 44 + 6 * Math.cos(0.1 * t), y: 19 + 6 * Math.sin(0.1 * t), yaw: 0.1 * t + Math.PI / 2 });

/** Ranges to the nearest wall, as the real scan frame: MDS2. */
function scanFrame(pose, count) {
  const frame = Buffer.alloc(36 + 4 * count);
  frame.write("MDS2", 0, "ascii");
  frame.writeUInt32LE(count, 4);
  [pose.x, pose.y, pose.yaw].forEach((value, i) => frame.writeDoubleLE(value, 8 + 8 * i));
  frame.writeFloatLE(0.005, 32);
  for (let i = 0; i < count; ++i) {
    const angle = (2 * Math.PI * i) / count;
    const [dx, dy] = [Math.cos(angle + pose.yaw), Math.sin(angle + pose.yaw)];
    let range = 100;
    for (const [x1, y1, x2, y2] of walls) {
      const [ex, ey] = [x2 - x1, y2 - y1];
      const cross = dx * ey - dy * ex;
      const along = ((x1 - pose.x) * ey - (y1 - pose.y) * ex) / cross;
      const share = ((x1 - pose.x) * dy - (y1 - pose.y) * dx) / cross;
      if (along > 0 && along < range && share >= 0 && share <= 1) range = along;
    }
    frame.writeInt16LE(Math.round((range * Math.cos(angle)) / 0.005), 36 + 4 * i);
    frame.writeInt16LE(Math.round((range * Math.sin(angle)) / 0.005), 38 + 4 * i);
  }
  return frame;
}

function liveState(t) {
  const waiting = Math.floor(t / 10) % 2 === 1;
  return {
    stamp: Date.now() / 1000, state: waiting ? "waiting" : "driving",
    cause: waiting ? { code: "something-in-the-way", values: {}, text: "something stands in the way" } : none,
    remedy: waiting ? { code: "once-clear", values: {}, text: "it goes on by itself once clear" } : none,
    since: Date.now() / 1000 - (t % 10), pose: { ...poseAt(t), covariance: [0.04, 0.01, 0.02, 1e-4], health: "LOCALIZED", health_reason: "", age_s: 0.05 },
    speed: waiting ? 0 : 0.6, turn_rate: 0.1, battery_v: 25.3, emergency_stop: false, order: 7, goal: "Press 1",
    path: Array.from({ length: 40 }, (_, i) => Object.values(poseAt(t + i)).slice(0, 2)), blocked: waiting ? [[40, 24], [39, 23]] : [],
    particles: Array.from({ length: 100 }, (_, i) => [poseAt(t).x + 0.3 * Math.sin(i), poseAt(t).y + 0.3 * Math.cos(1.7 * i), 0]),
    devices: [{ name: "top", type: "made_up", title: "Made-up", healthy: true, age_s: 0.05, detail: none, rate_hz: 10 }, { name: "drive", type: "drive", title: "", healthy: true, age_s: 0.02, detail: none, rate_hz: 50 }],
    score: 0.91, odometer_m: 1234.5, drivable: true, locked: none, revisions, editors: [], camera: false,
  };
}

const lidar = { name: "top", type: "made_up", x_m: 0.3, y_m: 0, z_m: 1.2, yaw_deg: 0 };
const vehicle = { length_m: 1, width_m: 0.6, base_to_rear_m: 0.2, max_speed_mps: 1, height_m: 0.8, wheel_radius_m: 0.1, half_wheel_separation_m: 0.25, max_acceleration_mps2: 0.5, max_turn_rate_radps: 1, max_deceleration_mps2: 0.8, max_turn_acceleration_radps2: 1.5, reaction_s: 0.25 };
const answers = {
  "/api/session": () => ({ role: "integrator", needs_pin: false }),
  "/api/site": () => ({
    name: "Made up", drawing: kDrawing, scale: { m_per_px: kScale, method: "known", relative_uncertainty: 0.002, residual_m: 0.01, date: "2026-01-01" }, georeference: null,
    vehicle, sensors: [lidar], route_metric: "hops", walls_revision: "1", routes_revision: "1", vehicle_revision: "1", attribution: "",
  }),
  "/api/setup": () => ({ steps: ["drawing", "scale", "routes", "vehicle", "locate"].map((name) => ({ name, done: name !== "locate", what: none })), drivable: true, locked: none }),
  "/api/site/walls": () => ({ revision: "1", walls: walls.map((wall) => [...wall, -1]) }),
  "/api/site/walls/seen": () => [
    { id: 1, segment: walls[0], state: "confirmed", share: 0.9, offset_m: 0 }, { id: 2, segment: walls[6], state: "missing", share: 0.1, offset_m: 0 },
    { id: 3, segment: walls[7], state: "displaced", share: 0.4, offset_m: 0.3 },
  ],
  "/api/site/routes": () => ({ revision: "1", nodes, legs, findings }),
  "/api/site/routes/check": () => ({ revision: "1", nodes, legs, findings }),
  "/api/site/tiles": () => ({ source: "", attribution: "", zoom: 0, tiles: [], latitude_deg: null, longitude_deg: null, tile_px: 256 }),
  "/api/site/tiles/sources": () => [{ name: "seamlessphoto", min_zoom: 2, max_zoom: 18, attribution: "国土地理院" }],
  "/api/site/scale": () => ({
    m_per_px: kScale, relative_uncertainty: 0.003, residuals: [{ label: "1", residual_m: 0.012, outlier: false }], verdict: "good", text: "", mirrored: false, applied: false,
    method: "known", georeference: null, overlay: null, disagreements: [], reason: { code: "scale-good", values: {}, text: "good" }, notes: [],
  }),
  "/api/devices": () => [{ type: "made_up", title: "Made-up", address: "udp 2368", heard: true, detail: none, sensor: lidar }, { type: "drive", title: "", address: "/dev/ttyUSB0", heard: true, detail: none, sensor: null }, { type: "other", title: "Other", address: "/dev/ttyUSB1", heard: false, detail: none, sensor: null }],
  "/api/vehicle/braking": () => ({ running: false, stops_now: 0, stops_wanted: 3, way_m: 4.3, trouble: none, stops: [], verdict: null }),
  "/api/devices/views": () => [{ name: "top", type: "made_up", place: "UDP 2368", rate_hz: 10, silence_s: 0.05, lost: 3, refused: 0, state: { code: "heard", values: {}, text: "heard" }, points: Array.from({ length: 360 }, (_, i) => [6 * Math.cos(i / 57.3), Math.max(-4, Math.min(4, 6 * Math.sin(i / 57.3)))]).flat() }],
  "/api/mounting": () => ({ state: "done", progress: 1, notice: none, rows: [{ typed: lidar, found: { ...lidar, x_m: 0.312, y_m: -0.006, z_m: 1.214, yaw_deg: 1.37 }, known: "all", height_known: true, sigma_m: 0.002, sigma_deg: 0.1, residual_m: 0.005, tilt_deg: 0.3, lack: none }] }),
  "/api/locate": () => ({ state: "ambiguous", hypotheses: [{ ...poseAt(0), score: 0.91 }, { x: 14, y: 12, yaw: 1, score: 0.47 }] }),
  "/api/orders": () => [order(7, "running", [0, 3], 5), order(8, "queued", [4]), order(9, "queued", [3, 0])],
  "/api/orders/history": () => [order(6, "done", [4]), order(5, "failed", [3])],
  "/api/events": () => [
    { stamp: 1767225600, severity: "stop", what: { code: "something-in-the-way", values: {}, text: "something stands in the way" }, remedy: { code: "once-clear", values: {}, text: "it goes on by itself once clear" } },
    { stamp: 1767225500, severity: "info", what: { code: "", values: {}, text: "order 6 delivered" }, remedy: none },
  ],
  "/api/statistics": () => ({ deliveries: 42, distance_m: 12345, driving_s: 45000, standing_s: 9000, since: 1767225600, stops: [{ cause: { code: "something-in-the-way", values: {}, text: "" }, count: 12, seconds: 300 }, { cause: { code: "door-not-open", values: {}, text: "" }, count: 4, seconds: 90 }] }),
  "/api/site/versions": () => [{ number: 1, stamp: 1767225600, author: "panel", sentence: "drawing, walls" }, { number: 2, stamp: 1767229200, author: "panel", sentence: "routes" }],
  "/api/site/days": () => dayList(),
  "/api/site/walls/doubted": () => [{ segments: [[2, 26, 8, 26]], length_m: 6, looks: 17 }, { segments: [[40, 20, 42, 20]], length_m: 2, looks: 8 }],
  "/api/recordings": () => [{ name: "2026-01-01T00-00-00Z", bytes: 123456789, modified: 1767225600 }],
};

const kKeptDays = [16, 9, 8, 7, 5, 3, 2, 1, 0];
const dayList = () => ({ days: kKeptDays.map((days) => ({ date: dayBefore(days), extent: [0, 0, 60, 40] })), skipped: [], of_other_frames: 2 });

/** The picture of a kept day. */
function dayPicture(date) {
  const { width, height, cells } = hallDay(walls, date < dayBefore(2) ? then : now, date < dayBefore(2) ? [] : [then[0]]);
  const rows = Buffer.alloc(height * (width + 1));
  for (let y = 0; y < height; ++y) rows.set(cells.subarray(y * width, (y + 1) * width), y * (width + 1) + 1);
  return picture(width, height, rows);
}

/** Addresses that hold dates: what is answered. */
function answerOfDays(path) {
  const against = path.match(/^\/api\/site\/days\/([\d-]+)\/against\/([\d-]+)$/);
  if (!against) return null;
  const [from, to] = against.slice(1).sort();
  return { from, to, changes: from < dayBefore(2) && to >= dayBefore(2) ? madeUpChanges() : [] };
}

function wsFrame(data, text) {
  const head = data.length < 126 ? Buffer.from([0x80 | (text ? 1 : 2), data.length]) : Buffer.alloc(data.length < 65536 ? 4 : 10);
  if (data.length >= 126) {
    head[0] = 0x80 | (text ? 1 : 2);
    head[1] = data.length < 65536 ? 126 : 127;
    if (data.length < 65536) head.writeUInt16BE(data.length, 2);
    else head.writeBigUInt64BE(BigInt(data.length), 2);
  }
  return Buffer.concat([head, data]);
}

function serveLive(socket, key, points, told) {
  const accept = createHash("sha1").update(`${key}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest("base64");
  socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\n\r\n`);
  const frames = Array.from({ length: 20 }, (_, i) => scanFrame(poseAt(i / 10), points));
  let tick = 0;
  const timer = setInterval(() => {
    if (told.held) return;
    socket.write(wsFrame(frames[tick % frames.length], false));
    socket.write(wsFrame(Buffer.from(JSON.stringify({ live: { ...liveState(tick / 10), ...told.live } })), true));
    ++tick;
  }, 100);
  for (const end of ["close", "error"]) socket.on(end, () => clearInterval(timer));
  socket.on("data", () => undefined);
}

/** Serves `page` (a built page's folder). Answers its address, `say` (parts of the live state from now on), `hold` (send nothing), `answer` (to an address from now on) and how to end it. */
export function startMadeUpVehicle(page, { points = 20_000 } = {}) {
  const png = drawing();
  const told = { live: {}, held: false, answers: {} };
  const server = createServer((request, answer) => {
    const path = new URL(request.url, "http://x").pathname;
    const json = path in told.answers ? () => told.answers[path] : answers[path];
    if (json) return answer.writeHead(200, { "Content-Type": "application/json" }).end(JSON.stringify(json()));
    if (path === "/api/site/drawing.png") return answer.writeHead(200, { "Content-Type": "image/png" }).end(png);
    const day = path.match(/^\/api\/site\/days\/([\d-]+)\/map\.png$/);
    if (day) return answer.writeHead(200, { "Content-Type": "image/png" }).end(dayPicture(day[1]));
    const ofDays = answerOfDays(path);
    if (ofDays) return answer.writeHead(200, { "Content-Type": "application/json" }).end(JSON.stringify(ofDays));
    if (path === "/api/replay") return answer.writeHead(200).end();
    if (path.startsWith("/api/")) return answer.writeHead(200, { "Content-Type": "application/json" }).end("{}");
    const file = join(page, path === "/" ? "index.html" : path);
    try {
      answer.writeHead(200, { "Content-Type": kTypes[extname(file)] ?? "application/octet-stream" }).end(readFileSync(file));
    } catch {
      answer.writeHead(404).end();
    }
  });
  server.on("upgrade", (request, socket) => serveLive(socket, request.headers["sec-websocket-key"], points, told));
  return new Promise((done) => server.listen(0, "127.0.0.1", () => done({ address: `http://127.0.0.1:${server.address().port}/`, say: (live) => { told.live = live; }, hold: (held) => { told.held = held; }, answer: (path, json) => { told.answers[path] = json; }, stop: () => { server.closeAllConnections(); server.close(); } })));
}
