import { useEffect } from "preact/hooks";
import { holding, stepBy, type Push } from "./jog_hold";

/** Nine keys, by their place on the keyboard: the number block, and U I O / J K L / M , . */
const keys: Record<string, Push> = {
  Numpad7: [1, 1], Numpad8: [1, 0], Numpad9: [1, -1], Numpad4: [0, 1], Numpad5: [0, 0], Numpad6: [0, -1], Numpad1: [-1, 1], Numpad2: [-1, 0], Numpad3: [-1, -1],
  KeyU: [1, 1], KeyI: [1, 0], KeyO: [1, -1], KeyJ: [0, 1], KeyK: [0, 0], KeyL: [0, -1], KeyM: [-1, 1], Comma: [-1, 0], Period: [-1, -1],
};
const steps: Record<string, number> = { PageUp: 1, PageDown: -1 };

/** What keys that are held together ask for; null: to stand. */
export function pushOf(held: ReadonlySet<string>): Push | null {
  let [ahead, left] = [0, 0];
  for (const code of held) {
    const push = keys[code];
    if (!push) continue;
    if (push[0] === 0 && push[1] === 0) return null;
    ahead += push[0];
    left += push[1];
  }
  const clip = (v: number) => Math.min(1, Math.max(-1, v));
  return ahead === 0 && left === 0 ? null : [clip(ahead), clip(left)];
}

const kDead = 0.15;
const kShoulders = [4, 5];

/** The left stick, while a button at the shoulder is held: a gamepad that lies on a table drives nothing. */
export function pushOfPad(axes: readonly number[], pressed: readonly boolean[]): Push | null {
  const [x = 0, y = 0] = axes;
  if (!kShoulders.some((button) => pressed[button]) || Math.hypot(x, y) < kDead) return null;
  return [-y, -x];
}

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
