import { useText } from "../i18n";
import { live } from "../live/live_socket";
import { useStore } from "../store";
import { HoldButton } from "./hold_button";
import { noticeText } from "../i18n";

const JOG_MPS = 0.3;
const JOG_RADPS = 0.4;

/** Driving by hand: the vehicle moves only while a button is held. */
export function Jog() {
  const t = useText();
  const refusal = useStore(live.refusal);
  const hold = (linear: number, angular: number) => ({
    held: () => live.jog(linear, angular),
    released: () => live.jog(0, 0),
  });
  return (
    <section class="jog-card">
      <div class="jog">
        <HoldButton icon="left" label={t("drive.left")} {...hold(0, JOG_RADPS)} />
        <HoldButton icon="up" label={t("drive.forward")} {...hold(JOG_MPS, 0)} />
        <HoldButton icon="right" label={t("drive.right")} {...hold(0, -JOG_RADPS)} />
        <HoldButton icon="down" label={t("drive.backward")} {...hold(-JOG_MPS, 0)} />
      </div>
      {refusal && <p class="bad" role="status">{noticeText(t, "error", refusal)}</p>}
      <p class="quiet">{t("drive.jog.hint")}</p>
    </section>
  );
}
