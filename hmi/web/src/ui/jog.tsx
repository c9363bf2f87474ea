import type { ComponentChildren } from "preact";
import { noticeText, useText } from "../i18n";
import { live } from "../live/live_socket";
import { useStore } from "../store";
import { HoldButton } from "./hold_button";
import { jogSpeeds, jogStep } from "./jog_hold";
import { Tool } from "./tool";

/** One touch: the next faster step, behind the fastest the slowest. */
function SpeedStep() {
  const t = useText();
  const step = useStore(jogStep);
  const [mps] = jogSpeeds[step] ?? jogSpeeds[0];
  return <Tool icon="chart" label={t("jog.speed", { speed: mps })} onClick={() => jogStep.set((step + 1) % jogSpeeds.length)} />;
}

/** Driving by hand: the vehicle moves only while a button is held. `corner`: a button that belongs to it. */
export function Jog({ corner, hint = true }: { corner?: ComponentChildren; hint?: boolean }) {
  const t = useText();
  const refusal = useStore(live.refusal);
  const [mps, radps] = jogSpeeds[useStore(jogStep)] ?? jogSpeeds[0];
  const hold = (linear: number, angular: number) => ({
    held: () => live.jog(linear, angular),
    released: () => live.jog(0, 0),
  });
  return (
    <section class="jog-card">
      <div class="jog">
        <HoldButton icon="left" label={t("drive.left")} {...hold(0, radps)} />
        <HoldButton icon="up" label={t("drive.forward")} {...hold(mps, 0)} />
        <HoldButton icon="right" label={t("drive.right")} {...hold(0, -radps)} />
        <SpeedStep />
        <HoldButton icon="down" label={t("drive.backward")} {...hold(-mps, 0)} />
        {corner}
      </div>
      {refusal && <p class="bad" role="status">{noticeText(t, "error", refusal)}</p>}
      {hint && <p class="quiet">{t("drive.jog.hint")}</p>}
      <p class="quiet">{t("jog.keys")}</p>
    </section>
  );
}
