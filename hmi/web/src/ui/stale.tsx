import { useEffect, useRef, useState } from "preact/hooks";
import { useText } from "../i18n";
import type { Frame } from "../live/live_socket";

export const STALE_S = 1.0;

const kTick_ms = 250;

/** Seconds since the newest message, counted on when none comes. */
export function useAge(frame: Frame | null): number {
  const [now, setNow] = useState(performance.now());
  const newest = useRef(frame);
  newest.current = frame;
  useEffect(() => {
    const timer = setInterval(() => {
      const now_ms = performance.now();
      if (now_ms - (newest.current?.received_ms ?? 0) > kTick_ms) setNow(now_ms);
    }, kTick_ms);
    return () => clearInterval(timer);
  }, []);
  return frame ? Math.max(0, (now - frame.received_ms) / 1000) : Infinity;
}

/** Says how old something is, once it is old. */
export function Stale({ age, limit = STALE_S }: { age: number; limit?: number }) {
  const t = useText();
  if (age <= limit) return null;
  return <em class="stale">{age > 3600 ? t("live.never") : t("live.stale", { age: age.toFixed(0) })}</em>;
}
