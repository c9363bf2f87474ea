import Layer from "ol/layer/Layer";

/** Draws tens of thousands of points straight into pixels: OpenLayers' features would be far too slow for a live scan. */
export function pointLayer(): { layer: Layer; show: (points: Float32Array) => void } {
  const canvas = document.createElement("canvas");
  canvas.style.position = "absolute";
  let points = new Float32Array();
  let pixels: ImageData | null = null;

  const layer = new Layer({
    render: (frame) => {
      if (!frame) return canvas;
      const [width = 1, height = 1] = frame.size;
      if (canvas.width !== width || canvas.height !== height || !pixels) {
        canvas.width = width;
        canvas.height = height;
        pixels = new ImageData(width, height);
      }
      const [cx = 0, cy = 0] = frame.viewState.center;
      const perMetre = 1 / frame.viewState.resolution;
      const colour = document.documentElement.dataset.theme === "dark" ? 0xffffc890 : 0xff7a2d00;  // ABGR
      const target = new Uint32Array(pixels.data.buffer);
      target.fill(0);
      for (let i = 0; i + 1 < points.length; i += 2) {
        const u = Math.round(width / 2 + ((points[i] ?? 0) - cx) * perMetre);
        const v = Math.round(height / 2 - ((points[i + 1] ?? 0) - cy) * perMetre);
        if (u < 0 || v < 0 || u >= width - 1 || v >= height - 1) continue;
        const at = v * width + u;
        target[at] = target[at + 1] = target[at + width] = target[at + width + 1] = colour;
      }
      canvas.getContext("2d")?.putImageData(pixels, 0, 0);
      return canvas;
    },
  });
  return {
    layer,
    show: (next) => {
      points = next as Float32Array<ArrayBuffer>;
      layer.changed();
    },
  };
}
