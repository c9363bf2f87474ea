/** Shares of full speed ahead and of full turn to the left, -1 to 1. */
export type Push = readonly [ahead: number, left: number];

/** nearer to the middle than this the vehicle stands, and a thumb that goes straight ahead does not turn */
const kPadDead = 0.12;

const past = (share: number) => (Math.abs(share) < kPadDead ? 0 : (share - Math.sign(share) * kPadDead) / (1 - kPadDead));

/** A place on the pad, shares of its radius to the right and upwards, as what it asks for. */
export function pushAt(right: number, up: number): Push {
  const size = Math.max(1, Math.hypot(right, up));
  return [past(up / size), past(-right / size)];
}

/** Nine keys, by their place on the keyboard: the number block, and U I O / J K L / M , . */
export const keys: Record<string, Push> = {
  Numpad7: [1, 1], Numpad8: [1, 0], Numpad9: [1, -1], Numpad4: [0, 1], Numpad5: [0, 0], Numpad6: [0, -1], Numpad1: [-1, 1], Numpad2: [-1, 0], Numpad3: [-1, -1],
  KeyU: [1, 1], KeyI: [1, 0], KeyO: [1, -1], KeyJ: [0, 1], KeyK: [0, 0], KeyL: [0, -1], KeyM: [-1, 1], Comma: [-1, 0], Period: [-1, -1],
};
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
