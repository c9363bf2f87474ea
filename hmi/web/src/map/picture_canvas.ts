/** A picture on a canvas of its size, and what its pixels are read by; null where the browser has no such canvas. */
export async function canvasOf(url: string): Promise<{ canvas: HTMLCanvasElement; context: CanvasRenderingContext2D | null }> {
  const image = new Image();
  image.src = url;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context?.drawImage(image, 0, 0);
  return { canvas, context };
}
