import { api, Refused } from "../api";
import { Store } from "../store";

/** A Stop that the vehicle has not confirmed yet: since when (performance.now()). */
export const unheardStop = new Store<number | null>(null);

const kAgain_ms = 250;
const kAnswer_ms = 1000;
const kGiveUp_ms = 60_000;

/** Stops as the person at the page may: an operator's Stop ends the order too; anybody may halt the vehicle. */
async function stopOnce(mayCommand: boolean): Promise<void> {
  if (!mayCommand) return void (await api.halt(kAnswer_ms));
  try {
    await api.stop(kAnswer_ms);
  } catch (error) {
    if (error instanceof Refused && (error.status === 401 || error.status === 403)) return void (await api.halt(kAnswer_ms));
    throw error;
  }
}

let pressed = 0;

/**
 * Stops the vehicle, whoever presses and whatever the connection does: it is sent again until the vehicle has confirmed
 * it, for a minute at most. Until then `unheardStop` says so, so that a person takes the button on the vehicle.
 */
export async function pressStop(mayCommand: boolean): Promise<void> {
  const mine = ++pressed;
  const begun = performance.now();
  while (mine === pressed && performance.now() - begun < kGiveUp_ms) {
    try {
      await stopOnce(mayCommand);
      return unheardStop.set(null);
    } catch {
      if (mine === pressed) unheardStop.set(begun);
      await new Promise((again) => setTimeout(again, kAgain_ms));
    }
  }
}

/** Nobody waits for it any more. */
export function forgetStop(): void {
  ++pressed;
  unheardStop.set(null);
}
