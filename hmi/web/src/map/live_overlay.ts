import type OlMap from "ol/Map";
import type { Live, VehicleInfo } from "../api_types";
import type { Scan } from "../live/scan_frame";
import { ellipseRing, footprint, type XY } from "./geometry";
import { palette } from "./theme";

type ToScreen = (x: number, y: number) => XY;

/** What moves: scan, particles, path, vehicle. */
export interface Moving {
  scan: Scan;
  /** the scan is drawn at this pose instead of its own */
  scanAt?: { x: number; y: number; yaw: number };
  live: Live | null;
  vehicle: VehicleInfo;
  /** of before: drawn pale */
  stale: boolean;
  /** false while nobody knows where the vehicle is: then it has no place on the map */
  vehicleShown: boolean;
  scanShown: boolean;
}

/** Points straight into pixels, two by two: tens of thousands a tenth of a second are too many for features. */
function drawPoints(context: CanvasRenderingContext2D, pixels: ImageData, moving: Moving, map: OlMap): void {
  const { width, height } = pixels;
  const words = new Uint32Array(pixels.data.buffer);
  words.fill(0);
  if (!moving.scanShown) return context.putImageData(pixels, 0, 0);
  const { points } = moving.scan;
  const { x, y, yaw } = moving.scanAt ?? moving.scan;
  const [cx = 0, cy = 0] = map.getView().getCenter() ?? [];
  const scale = 1 / (map.getView().getResolution() ?? 1);
  const [r, g, b] = palette().scan;
  const colour = ((moving.stale ? 0x60000000 : 0xff000000) | (b << 16) | (g << 8) | r) >>> 0;
  const cos = Math.cos(yaw) * scale;
  const sin = Math.sin(yaw) * scale;
  const u0 = width / 2 + (x - cx) * scale;
  const v0 = height / 2 - (y - cy) * scale;
  for (let i = 0; i + 1 < points.length; i += 2) {
    const px = points[i] as number;
    const py = points[i + 1] as number;
    const u = (u0 + cos * px - sin * py) | 0;
    const v = (v0 - sin * px - cos * py) | 0;
    if (u < 0 || v < 0 || u >= width - 1 || v >= height - 1) continue;
    const at = v * width + u;
    words[at] = words[at + 1] = words[at + width] = words[at + width + 1] = colour;
  }
  context.putImageData(pixels, 0, 0);
}

function trace(context: CanvasRenderingContext2D, points: readonly (readonly number[])[], to: ToScreen): void {
  context.beginPath();
  points.forEach(([x = 0, y = 0], i) => (i === 0 ? context.moveTo(...to(x, y)) : context.lineTo(...to(x, y))));
}

function drawBlocked(context: CanvasRenderingContext2D, at: XY): void {
  const r = 9;
  context.lineWidth = 5;
  context.strokeStyle = palette().red;
  context.beginPath();
  context.moveTo(at[0] - r, at[1] - r);
  context.lineTo(at[0] + r, at[1] + r);
  context.moveTo(at[0] - r, at[1] + r);
  context.lineTo(at[0] + r, at[1] - r);
  context.stroke();
}

/** The outline in its true size, and an arrow that stays large enough to be seen. */
export function drawVehicle(context: CanvasRenderingContext2D, pose: { x: number; y: number; yaw: number }, vehicle: VehicleInfo, fill: string, to: ToScreen): void {
  const { paper } = palette();
  trace(context, footprint(pose, vehicle), to);
  context.fillStyle = fill;
  context.fill();
  const [u, v] = to(pose.x, pose.y);
  const c = Math.cos(pose.yaw);
  const s = Math.sin(pose.yaw);
  context.beginPath();
  for (const [x, y] of [[18, 0], [-10, 11], [-5, 0], [-10, -11]] as XY[]) context.lineTo(u + c * x - s * y, v - s * x - c * y);
  context.closePath();
  context.fill();
  context.lineWidth = 2.5;
  context.strokeStyle = paper;
  context.stroke();
}

function drawState(context: CanvasRenderingContext2D, live: Live, vehicle: VehicleInfo, shown: boolean, to: ToScreen): void {
  const { ink, grey, amber, red } = palette();
  context.fillStyle = grey;
  for (const [x = 0, y = 0] of live.particles) {
    const [u, v] = to(x, y);
    context.fillRect(u - 1, v - 1, 3, 3);
  }
  if (!shown) return;
  if (live.path.length > 1) {
    trace(context, live.path, to);
    context.setLineDash([12, 8]);
    context.lineWidth = 5;
    context.strokeStyle = ink;
    context.stroke();
  }
  const { pose } = live;
  trace(context, ellipseRing([pose.x, pose.y], pose.covariance, 2), to);
  context.setLineDash([4, 4]);
  context.lineWidth = 2;
  context.strokeStyle = ink;
  context.stroke();
  context.setLineDash([]);
  const fills: Record<string, string> = { LOCALIZED: ink, LOST: red };
  drawVehicle(context, pose, vehicle, fills[pose.health] ?? amber, to);
  for (const [x = 0, y = 0] of live.blocked) drawBlocked(context, to(x, y));
}

/** Two canvases above an OpenLayers map: what moves does not make the map draw its walls again, nor a vehicle the scan. */
export class LiveOverlay {
  readonly canvas = document.createElement("canvas");
  private readonly scanCanvas = document.createElement("canvas");
  private readonly context = this.canvas.getContext("2d");
  private readonly scanContext = this.scanCanvas.getContext("2d");
  private pixels: ImageData | null = null;
  private moving: Moving | null = null;
  /** what the scan on the canvas was drawn from */
  private drawn: readonly unknown[] = [];
  private wanted = 0;

  constructor(private readonly map: OlMap) {
    for (const canvas of [this.scanCanvas, this.canvas]) {
      canvas.className = "live-overlay";
      (map.getViewport() as HTMLElement).append(canvas);
    }
    map.on("postrender", () => this.draw());
  }

  show(moving: Moving): void {
    this.moving = moving;
    const target = this.map.getTargetElement();  // what is shown, so that a test can ask
    const word = (is: boolean) => (!is ? "hidden" : moving.stale ? "old" : "shown");
    target?.setAttribute("data-vehicle", word(moving.vehicleShown));
    target?.setAttribute("data-scan", word(moving.scanShown));
    this.wanted ||= requestAnimationFrame(() => this.draw());  // messages that came late together are drawn once
  }

  /** The scan comes half as often as the state, and its canvas is the larger work: it is drawn when it or the view changed. */
  private drawScan(moving: Moving, pixels: ImageData): void {
    const view = this.map.getView();
    const { x, y, yaw } = moving.scanAt ?? moving.scan;
    const now = [moving.scan, x, y, yaw, moving.scanShown, moving.stale, pixels, palette(), view.getCenter()?.join(), view.getResolution()];
    if (now.every((each, i) => each === this.drawn[i])) return;
    this.drawn = now;
    if (this.scanContext) drawPoints(this.scanContext, pixels, moving, this.map);
  }

  private fitSize(): boolean {
    const [width = 0, height = 0] = this.map.getSize() ?? [];
    if (width === 0 || height === 0) return false;
    if (this.pixels?.width !== width || this.pixels.height !== height) {
      for (const canvas of [this.scanCanvas, this.canvas]) {
        canvas.width = width;
        canvas.height = height;
      }
      this.pixels = new ImageData(width, height);
    }
    return true;
  }

  private draw(): void {
    cancelAnimationFrame(this.wanted);
    this.wanted = 0;
    if (!this.moving || !this.context || !this.fitSize() || !this.pixels) return;
    this.drawScan(this.moving, this.pixels);
    this.context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.canvas.style.opacity = this.moving.stale ? "0.35" : "1";
    const [cx = 0, cy = 0] = this.map.getView().getCenter() ?? [];
    const resolution = this.map.getView().getResolution() ?? 1;
    const to: ToScreen = (x, y) => [this.canvas.width / 2 + (x - cx) / resolution, this.canvas.height / 2 - (y - cy) / resolution];
    const { live, vehicle, scanAt } = this.moving;
    if (live) drawState(this.context, live, vehicle, this.moving.vehicleShown, to);
    else if (scanAt) drawVehicle(this.context, scanAt, vehicle, palette().ink, to);
  }
}
