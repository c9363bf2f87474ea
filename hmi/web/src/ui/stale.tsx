import { useEffect, useState } from "preact/hooks";
import { useText } from "../i18n";
import type { Frame } from "../live/live_socket";

export const STALE_S = 1.0;

/** Seconds since the newest message, counted on when none comes. */
export function useAge(frame: Frame | null): number {
  const [now, setNow] = useState(performance.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 250);
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
