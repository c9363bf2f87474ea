import ImageLayer from "ol/layer/Image";
import ImageCanvas from "ol/source/ImageCanvas";
import { api } from "../api";
import type { KeptDay } from "../api_types";
import type { FactoryMap } from "./factory_map";
import { canvasOf } from "./picture_canvas";
import { palette, theme } from "./theme";

const kAges = 42; // values of a state, one for each age in days: hmi/schema, KeptDays
const kStates = ["unseen", "free", "moving", "semi_static", "static", "taken_away"] as const;

/** The states that are drawn, in the order of the legend, and the palette's name of each one's colour. What moves is nowhere by the next day. */
export const dayColours = { static: "grey", semi_static: "blue", taken_away: "amber", free: "floor" } as const;

/** A colour #rrggbb as a pixel of ImageData. */
const wordOf = (hex: string): number => {
  const [r = 0, g = 0, b = 0] = [1, 3, 5].map((at) => Number.parseInt(hex.slice(at, at + 2), 16));
  return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
};

async function pixelsOf(url: string): Promise<ImageData> {
  const { canvas, context } = await canvasOf(url);
  if (!context) throw new Error("no canvas");
  return context.getImageData(0, 0, canvas.width, canvas.height);
}

/** The cells in the colours of the theme. */
function painted(grey: ImageData): HTMLCanvasElement {
  const colours = kStates.map((state) => (state in dayColours ? wordOf(palette()[dayColours[state as keyof typeof dayColours]]) : 0));
  const pixels = new ImageData(grey.width, grey.height);
  const words = new Uint32Array(pixels.data.buffer);
  for (let i = 0; i < words.length; ++i) words[i] = colours[Math.floor((grey.data[4 * i] ?? 0) / kAges)] ?? 0;
  const canvas = document.createElement("canvas");
  canvas.width = grey.width;
  canvas.height = grey.height;
  canvas.getContext("2d")?.putImageData(pixels, 0, 0);
  return canvas;
}

/** What the living map read at the end of a day, below drawing and walls of a map. */
export class DayLayer {
  private readonly layer = new ImageLayer<ImageCanvas>();
  private readonly unwatch: () => void;
  private day: KeptDay | null = null;
  private grey: ImageData | null = null;

  constructor(private readonly on: FactoryMap) {
    on.map.getLayers().insertAt(0, this.layer);
    this.unwatch = theme.watch(() => this.paint());
  }

  dispose(): void {
    this.unwatch();
    this.day = null;
  }

  /** Shows a day as soon as its picture has come; of days asked for in quick succession the last one. Throws where it cannot be read. */
  async show(day: KeptDay | null): Promise<void> {
    this.day = day;
    const grey = day ? await pixelsOf(api.dayUrl(day.date)) : null;
    if (this.day !== day) return;
    this.grey = grey;
    this.paint();
    this.on.map.getTargetElement()?.setAttribute("data-day", day?.date ?? "");  // so that a test can ask
  }

  private paint(): void {
    const { grey, day } = this;
    if (!grey || !day) return this.layer.setSource(null);
    const picture = painted(grey);
    const [x0 = 0, y0 = 0, x1 = 0, y1 = 0] = day.extent;
    this.layer.setSource(new ImageCanvas({
      projection: this.on.map.getView().getProjection(),
      ratio: 1,
      canvasFunction: ([left = 0, , right = 1, top = 0], _resolution, _ratio, [width = 1, height = 1]) => {
        const canvas = document.createElement("canvas");
        canvas.width = Math.ceil(width);
        canvas.height = Math.ceil(height);
        const context = canvas.getContext("2d");
        const perUnit = width / (right - left);
        if (context) context.imageSmoothingEnabled = false;  // a cell has the colour of its own state
        context?.drawImage(picture, (x0 - left) * perUnit, (top - y1) * perUnit, (x1 - x0) * perUnit, (y1 - y0) * perUnit);
        return canvas;
      },
    }));
  }
}
