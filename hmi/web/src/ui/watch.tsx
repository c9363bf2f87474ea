import { useText } from "../i18n";
import { live } from "../live/live_socket";
import { useStore } from "../store";
import { Icon } from "./icon";
import { useAge } from "./stale";
import { kLost_s, Silent } from "./state_card";

/**
 * On the pages without the state card: that there is no connection, or which device is silent. It lies over the page and
 * takes no touch, so that nothing moves under a finger.
 */
export function Watch() {
  const t = useText();
  const frame = useStore(live.newest);
  const connected = useStore(live.connected);
  const age = useAge(frame);
  const lost = !frame || !connected || age > kLost_s;
  const text = Number.isFinite(age) ? t("live.lost.mend", { age: age.toFixed(0) }) : t("live.none.mend");
  return (
    <div class="watch" role="status">
      {lost ? <p class="caution" data-watch="lost" data-connection="lost"><Icon name="warning" /> {t("live.lost")}. {text}</p> : <Silent frame={frame} age={age} />}
    </div>
  );
}
