import { useEffect, useRef } from "preact/hooks";

/** A map in the element `target`, which lives as long as the component. `ready` runs once; what it returns runs at the end. */
export function useMap<M extends { dispose: () => void }>(make: (target: HTMLElement) => M, ready: (map: M) => void | (() => void)) {
  const target = useRef<HTMLDivElement>(null);
  const map = useRef<M | null>(null);
  useEffect(() => {
    if (!target.current) return undefined;
    const made = make(target.current);
    map.current = made;
    const end = ready(made);
    return () => {
      end?.();
      made.dispose();
    };
    // eslint-disable-next-line -- once: who wants another map gives the component another key
  }, []);
  return { target, map };
}
