import { unByKey } from "ol/Observable";
import DragPan from "ol/interaction/DragPan";
import type OlMap from "ol/Map";
import type { XY } from "./geometry";
import { Loupe } from "./loupe";
import { snapTo } from "./snap";

const kHold_ms = 300;
const kStill_px = 8;
const kReach_px = 22;
const kAimedReach_px = 7;  // under the magnifier a person sees where the point goes

export interface Picking {
  /** called with the place in map coordinates and the metres (or pixels) a screen pixel */
  picked: (at: XY, resolution: number, snapped: boolean) => void;
  /** corners that attract the finger */
  corners: () => readonly XY[];
  /** false: touches only move the view */
  active: () => boolean;
}

/** A tap sets a point; a finger that rests gets a magnifier and sets it where it lets go; Enter sets it at the middle. */
export function pickOn(map: OlMap, picking: Picking): () => void {
  const viewport = map.getViewport() as HTMLElement;
  const loupe = new Loupe(map);
  let timer = 0;
  let began: XY | null = null;
  let aiming = false;
  let swallow = false;
  const resolution = () => map.getView().getResolution() ?? 1;
  const snap = (pixel: XY) => snapTo(picking.corners(), map.getCoordinateFromPixel(pixel) as XY, (aiming ? kAimedReach_px : kReach_px) * resolution());
  const pick = (pixel: XY) => {
    const { at, snapped } = snap(pixel);
    picking.picked(at, resolution(), snapped);
  };
  const pan = (on: boolean) => {
    for (const interaction of map.getInteractions().getArray()) if (interaction instanceof DragPan) interaction.setActive(on);
  };
  const show = (pixel: XY) => {
    const { at, snapped } = snap(pixel);
    loupe.show(pixel, map.getPixelFromCoordinate(at) as XY, snapped);
  };
  const here = (event: PointerEvent): XY => map.getEventPixel(event) as XY;
  const end = () => {
    clearTimeout(timer);
    began = null;
    if (aiming) {
      loupe.hide();
      pan(true);
    }
    aiming = false;
  };
  const down = (event: PointerEvent) => {
    swallow = false;
    if (!picking.active()) return;
    if (!event.isPrimary) return end();
    const pixel = here(event);
    began = pixel;
    timer = window.setTimeout(() => {
      aiming = true;
      pan(false);
      show(pixel);
    }, kHold_ms);
  };
  const move = (event: PointerEvent) => {
    if (!began) return;
    const pixel = here(event);
    if (aiming) show(pixel);
    else if (Math.hypot(pixel[0] - began[0], pixel[1] - began[1]) > kStill_px) end();
  };
  const up = (event: PointerEvent) => {
    if (aiming) {
      swallow = true;
      pick(here(event));
    }
    end();
  };
  const key = (event: KeyboardEvent) => {
    if (event.key !== "Enter" || !picking.active()) return;
    const [width = 0, height = 0] = map.getSize() ?? [];
    pick([width / 2, height / 2]);
  };
  const click = map.on("click", (event) => {
    if (!swallow && picking.active()) pick(event.pixel as XY);
    swallow = false;
  });
  const target = map.getTargetElement() as HTMLElement;
  viewport.addEventListener("pointerdown", down);
  viewport.addEventListener("pointermove", move);
  viewport.addEventListener("pointerup", up);
  viewport.addEventListener("pointercancel", end);
  target.addEventListener("keydown", key);
  return () => {
    end();
    unByKey(click);
    target.removeEventListener("keydown", key);
  };
}
