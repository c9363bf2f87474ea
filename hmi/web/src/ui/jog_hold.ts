import { live } from "../live/live_socket";
import { Store } from "../store";
import type { Push } from "./jog_push";

const REPEAT_MS = 80;

/** Full speed and turn of driving by hand, m/s and rad/s; the vehicle's own limits stay in charge. */
export const jogSpeeds = [[0.15, 0.25], [0.3, 0.4], [0.6, 0.8]] as const;
export const jogStep = new Store(1);
export const stepBy = (by: number) => jogStep.set(Math.min(jogSpeeds.length - 1, Math.max(0, jogStep.value + by)));

/** What a hand holds, whichever way it does: sent again and again while it holds, a stop once after. */
class Holding {
  private timer: number | null = null;
  private by = "";
  private push: Push = [0, 0];

  hold(by: string, push: Push): void {
    this.by = by;
    this.push = push;
    if (this.timer !== null) return;
    this.send();
    this.timer = window.setInterval(() => this.send(), REPEAT_MS);
  }

  release(by?: string): void {
    if (this.timer === null || (by !== undefined && by !== this.by)) return;
    clearInterval(this.timer);
    this.timer = null;
    live.jog(0, 0);
  }

  private send(): void {
    const [mps, radps] = jogSpeeds[jogStep.value] ?? jogSpeeds[0];
    live.jog(this.push[0] * mps, this.push[1] * radps);
  }
}

export const holding = new Holding();
