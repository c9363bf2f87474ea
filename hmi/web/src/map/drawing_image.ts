import { canvasOf } from "./picture_canvas";

/**
 * The drawing as ink on nothing: dark pixels take the colour, white paper becomes transparent, so that it lies well on
 * a light page, a dark one and a photograph.
 */
async function load(url: string, colour: readonly [number, number, number]): Promise<HTMLCanvasElement> {
  const { canvas, context } = await canvasOf(url);
  if (!context) return canvas;
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height);
  const words = new Uint32Array(pixels.data.buffer);
  const [r, g, b] = colour;
  const ink = r | (g << 8) | (b << 16);
  for (let i = 0; i < words.length; ++i) {
    const word = words[i] ?? 0;
    const brightness = ((word & 255) * 77 + ((word >> 8) & 255) * 150 + ((word >> 16) & 255) * 29) >> 8;
    words[i] = (((255 - brightness) * (word >>> 24)) / 255) << 24 | ink;
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}

const loaded = new Map<string, Promise<HTMLCanvasElement>>();

/** Loaded once for every url and colour; only the two newest are kept, for pictures are large. */
export function inkOf(url: string, colour: readonly [number, number, number]): Promise<HTMLCanvasElement> {
  const key = `${url} ${colour.join()}`;
  const known = loaded.get(key);
  if (known) return known;
  while (loaded.size > 1) loaded.delete(loaded.keys().next().value ?? "");
  const fresh = load(url, colour);
  loaded.set(key, fresh);
  fresh.catch(() => loaded.delete(key));
  return fresh;
}
