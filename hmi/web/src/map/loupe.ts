import type OlMap from "ol/Map";
import { palette } from "./theme";

const kSide = 220;
const kMagnified = 3;

/** A round magnifier above the finger: shows what the finger hides, with a cross where the point will be. */
export class Loupe {
  private readonly canvas = document.createElement("canvas");

  constructor(private readonly map: OlMap) {
    this.canvas.className = "loupe";
    this.canvas.width = this.canvas.height = kSide;
    this.canvas.hidden = true;
    (map.getViewport() as HTMLElement).append(this.canvas);
  }

  show(finger: readonly number[], point: readonly number[], snapped: boolean): void {
    const context = this.canvas.getContext("2d");
    if (!context) return;
    const [u = 0, v = 0] = point;
    const seen = kSide / kMagnified;
    const { paper, ink, blue } = palette();
    context.fillStyle = paper;
    context.fillRect(0, 0, kSide, kSide);
    for (const layer of (this.map.getViewport() as HTMLElement).querySelectorAll<HTMLCanvasElement>("canvas:not(.loupe)")) {
      const opacity = Number((layer.parentElement?.style.opacity ?? "") || 1);
      context.globalAlpha = opacity;
      context.drawImage(layer, u - seen / 2, v - seen / 2, seen, seen, 0, 0, kSide, kSide);
    }
    context.globalAlpha = 1;
    context.strokeStyle = snapped ? blue : ink;
    context.lineWidth = snapped ? 4 : 2;
    context.beginPath();
    for (const [x0, y0, x1, y1] of [[0, 0.5, 0.45, 0.5], [0.55, 0.5, 1, 0.5], [0.5, 0, 0.5, 0.45], [0.5, 0.55, 0.5, 1]] as const) {
      context.moveTo(x0 * kSide, y0 * kSide);
      context.lineTo(x1 * kSide, y1 * kSide);
    }
    context.stroke();
    if (snapped) context.strokeRect(kSide / 2 - 12, kSide / 2 - 12, 24, 24);
    const [width = 0] = this.map.getSize() ?? [];
    const left = Math.min(Math.max((finger[0] ?? 0) - kSide / 2, 4), Math.max(width - kSide - 4, 4));
    const above = (finger[1] ?? 0) - kSide - 50;
    this.canvas.style.left = `${left}px`;
    this.canvas.style.top = `${above >= 0 ? above : (finger[1] ?? 0) + 60}px`;
    this.canvas.hidden = false;
  }

  hide(): void {
    this.canvas.hidden = true;
  }
}
