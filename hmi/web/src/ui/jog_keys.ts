import { useEffect } from "preact/hooks";
import { holding, stepBy } from "./jog_hold";
import { keys, pushOf, pushOfPad } from "./jog_push";

const steps: Record<string, number> = { PageUp: 1, PageDown: -1 };

/** Whether a key is meant for something else: a field, the map, a card above the page. */
const taken = ({ target, ctrlKey, altKey, metaKey }: KeyboardEvent) =>
  ctrlKey || altKey || metaKey || document.querySelector(".above") !== null || (target instanceof Element && target.closest("input, textarea, select") !== null);

/** Keyboard and gamepad drive while the component is shown. */
export function useJogKeys(): void {
  useEffect(() => {
    const held = new Set<string>();
    const drive = () => {
      const push = pushOf(held);
      if (push) holding.hold("keys", push);
      else holding.release("keys");
    };
    const down = (event: KeyboardEvent) => {
      if (taken(event)) return;
      const step = steps[event.code];
      if (step !== undefined && !event.repeat) stepBy(step);
      if (!(event.code in keys) || held.has(event.code)) return;
      event.preventDefault();
      held.add(event.code);
      drive();
    };
    const up = (event: KeyboardEvent) => held.delete(event.code) && drive();
    const letGo = () => {
      held.clear();
      holding.release();
    };
    const hidden = () => document.hidden && letGo();
    const timer = setInterval(() => {
      const pads = [...navigator.getGamepads()].filter((pad) => pad !== null);
      const pushes = pads.map((pad) => pushOfPad(pad.axes, pad.buttons.map((button) => button.pressed)));
      const push = document.hidden ? null : pushes.find((one) => one !== null);
      if (push) holding.hold("gamepad", push);
      else holding.release("gamepad");
    }, 80);
    window.addEventListener("keydown", down);
    window.addEventListener("keyup", up);
    window.addEventListener("blur", letGo);
    document.addEventListener("visibilitychange", hidden);
    return () => {
      clearInterval(timer);
      window.removeEventListener("keydown", down);
      window.removeEventListener("keyup", up);
      window.removeEventListener("blur", letGo);
      document.removeEventListener("visibilitychange", hidden);
      letGo();
    };
  }, []);
}
