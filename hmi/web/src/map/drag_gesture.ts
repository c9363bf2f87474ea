import type OlMap from "ol/Map";
import type { XY } from "./geometry";
import { about, fromFingers, type Similarity } from "./similarity";

export interface Dragging {
  /** null: fingers move the view */
  middle: () => XY | null;
  /** where the handle for turning (and stretching) stands, map coordinates */
  handle: () => XY;
  rigid: boolean;
  moved: (by: Similarity) => void;
}

const kGrip_px = 60;

/**
 * One finger moves a thing on the map, a finger on its handle turns (and stretches) it about its middle, two fingers do
 * all at once. While it is active the map itself stands still.
 */
export function dragOn(map: OlMap, dragging: Dragging): () => void {
  const viewport = map.getViewport() as HTMLElement;
  const fingers = new Map<number, XY>();
  let turning = false;
  const place = (event: PointerEvent) => map.getCoordinateFromPixel(map.getEventPixel(event)) as XY;
  const down = (event: PointerEvent) => {
    const middle = dragging.middle();
    if (!middle) return;
    event.stopPropagation();
    viewport.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, place(event));
    const grip = map.getPixelFromCoordinate(dragging.handle());
    const at = map.getEventPixel(event);
    turning = fingers.size === 1 && Math.hypot((at[0] ?? 0) - (grip[0] ?? 0), (at[1] ?? 0) - (grip[1] ?? 0)) <= kGrip_px;
  };
  const move = (event: PointerEvent) => {
    const from = fingers.get(event.pointerId);
    const middle = dragging.middle();
    if (!from || !middle) return;
    event.stopPropagation();
    const to = place(event);
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    fingers.set(event.pointerId, to);
    if (other) dragging.moved(fromFingers([from, other], [to, other], dragging.rigid));
    else if (turning) dragging.moved(fromFingersAbout(middle, from, to, dragging.rigid));
    else dragging.moved({ a: 1, b: 0, tx: to[0] - from[0], ty: to[1] - from[1] });
  };
  const up = (event: PointerEvent) => {
    if (!fingers.delete(event.pointerId)) return;
    event.stopPropagation();
    turning = false;
  };
  const events = [["pointerdown", down], ["pointermove", move], ["pointerup", up], ["pointercancel", up]] as const;
  for (const [name, handler] of events) viewport.addEventListener(name, handler, { capture: true });
  return () => {
    for (const [name, handler] of events) viewport.removeEventListener(name, handler, { capture: true });
  };
}

function fromFingersAbout(middle: XY, from: XY, to: XY, rigid: boolean): Similarity {
  const before = Math.hypot(from[0] - middle[0], from[1] - middle[1]);
  const after = Math.hypot(to[0] - middle[0], to[1] - middle[1]);
  const angle = Math.atan2(to[1] - middle[1], to[0] - middle[0]) - Math.atan2(from[1] - middle[1], from[0] - middle[0]);
  return about(middle, angle, rigid || before === 0 ? 1 : after / before);
}
