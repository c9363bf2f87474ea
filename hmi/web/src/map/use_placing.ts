import Feature from "ol/Feature";
import { LineString } from "ol/geom";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { api } from "../api";
import type { Hypothesis, Locate, Site } from "../api_types";
import { live } from "../live/live_socket";
import { usePolled } from "../store";
import { placeAgain, type Pose } from "./chosen_place";
import { fitAt, piecesOf, type Fit } from "./contradictions";
import { dragOn } from "./drag_gesture";
import type { FactoryMap } from "./factory_map";
import type { XY } from "./geometry";
import { angleOf, apply, type Similarity } from "./similarity";

export type { Pose };

const kHandle_px = 110;
const kFit_ms = 250;

const moved = (pose: Pose, by: Similarity): Pose => {
  const [x, y] = apply(by, [pose.x, pose.y]);
  return { x, y, yaw: pose.yaw + angleOf(by) };
};

export interface Placing {
  locate: Locate | null;
  age_s: number;
  refresh: () => void;
  places: readonly Hypothesis[];
  /** of `places`; -1: what was chosen is not among them any more */
  chosen: number;
  choose: (index: number) => void;
  /** dragged by a finger; null: the chosen place */
  byHand: Pose | null;
  pose: Pose | null;
  fit: Fit | null;
  /** begins or ends placing by hand */
  toggleHand: () => void;
  /** lets fingers drag the scan on a map; answers what ends it */
  attach: (map: FactoryMap) => () => void;
}

/** The place that a person chose stays chosen where its rank changes; before, and once none is ranked, it is the first. */
function useChosen(places: readonly Hypothesis[]): { chosen: number; at: Pose | null; choose: (index: number) => void } {
  const held = useRef<{ pose: Pose; among: readonly Hypothesis[] } | null>(null);
  const [, drawAnew] = useState({});
  let chosen = 0;
  if (places.length === 0) held.current = null;
  else if (held.current) {
    const { pose, among } = held.current;
    chosen = placeAgain(pose, among, places);
    held.current = { pose: places[chosen] ?? pose, among: places };
  }
  const choose = (index: number) => {
    const pose = places[index];
    held.current = pose ? { pose, among: places } : null;
    drawAnew({});
  };
  return { chosen, at: held.current?.pose ?? places[0] ?? null, choose };
}

/** Ranked places and a scan that a finger can lay onto the walls: what the Drive page's card and the last step of Set up share. */
export function usePlacing(site: Site, walls: readonly number[][], shown: boolean): Placing {
  const { value: locate, refresh, age_s } = usePolled(api.locate, 1000, shown);
  const [byHand, setByHand] = useState<Pose | null>(null);
  const [fit, setFit] = useState<Fit | null>(null);
  const map = useRef<FactoryMap | null>(null);
  const pieces = useMemo(() => piecesOf(walls), [walls]);
  const places = locate?.hypotheses ?? [];
  const { chosen, at, choose } = useChosen(places);
  const pose = byHand ?? at;
  const now = useRef({ byHand, pose, shown });
  now.current = { byHand, pose, shown };
  useEffect(() => {
    if (!shown || !pose) return undefined;
    const show = () => {
      const scan = live.newest.value?.scan;
      if (scan) map.current?.live.show({ scan, scanAt: pose, live: null, vehicle: site.vehicle, stale: false, vehicleShown: true, scanShown: true });
    };
    show();
    return live.newest.watch(show);
  }, [shown, pose?.x, pose?.y, pose?.yaw]);
  useEffect(() => {
    if (!shown) {
      map.current?.sketch.clear();
      return undefined;
    }
    const look = () => {
      const scan = live.newest.value?.scan;
      const at = now.current.pose;
      const found = scan && at && scan.points.length > 0 ? fitAt(pieces, scan, at) : null;
      setFit(found);
      map.current?.sketch.clear();
      map.current?.sketch.addFeatures((found?.contradicted ?? []).map(([x1, y1, x2, y2]) => {
        const feature = new Feature(new LineString([[x1, y1], [x2, y2]]));
        feature.set("contradicted", true);
        return feature;
      }));
    };
    look();
    const timer = setInterval(look, kFit_ms);
    return () => clearInterval(timer);
  }, [shown, pieces]);
  const attach = (made: FactoryMap) => {
    map.current = made;
    const reach = () => kHandle_px * (made.map.getView().getResolution() ?? 1);
    const handle = (): XY => {
      const at = now.current.byHand ?? { x: 0, y: 0, yaw: 0 };
      return [at.x + reach() * Math.cos(at.yaw), at.y + reach() * Math.sin(at.yaw)];
    };
    return dragOn(made.map, {
      middle: () => (now.current.shown && now.current.byHand ? [now.current.byHand.x, now.current.byHand.y] : null),
      handle,
      rigid: true,
      moved: (by) => setByHand((old) => old && moved(old, by)),
    });
  };
  const toggleHand = () => {
    const [x, y] = map.current?.map.getView().getCenter() ?? [0, 0];
    setByHand(byHand ? null : (pose ?? { x: x ?? 0, y: y ?? 0, yaw: 0 }));
  };
  return { locate, age_s, refresh, places, chosen, choose, byHand, pose, fit, toggleHand, attach };
}
