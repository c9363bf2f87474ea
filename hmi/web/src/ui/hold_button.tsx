import { useEffect, useRef } from "preact/hooks";
import { Icon, type IconName } from "./icon";

const REPEAT_MS = 80;

/** Runs `held` again and again while a finger, the mouse or the space bar holds it, and `released` once after. */
export function HoldButton(props: { icon: IconName; label: string; held: () => void; released: () => void }) {
  const timer = useRef<number | null>(null);
  const stop = () => {
    if (timer.current === null) return;
    clearInterval(timer.current);
    timer.current = null;
    props.released();
  };
  const start = () => {
    if (timer.current !== null) return;
    props.held();
    timer.current = window.setInterval(() => props.held(), REPEAT_MS);
  };
  useEffect(() => {
    // A page in the background keeps no finger on a button.
    const hidden = () => document.hidden && stop();
    document.addEventListener("visibilitychange", hidden);
    window.addEventListener("blur", stop);
    return () => {
      document.removeEventListener("visibilitychange", hidden);
      window.removeEventListener("blur", stop);
      stop();
    };
    // eslint-disable-next-line -- once
  }, []);
  const isKey = (event: KeyboardEvent) => event.key === " " || event.key === "Enter";
  return (
    <button
      class="target hold"
      aria-label={props.label}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        start();
      }}
      onPointerUp={stop}
      onPointerCancel={stop}
      onLostPointerCapture={stop}
      onContextMenu={(event) => event.preventDefault()}
      onKeyDown={(event) => isKey(event) && start()}
      onKeyUp={(event) => isKey(event) && stop()}
    >
      <Icon name={props.icon} />
      <span>{props.label}</span>
    </button>
  );
}
