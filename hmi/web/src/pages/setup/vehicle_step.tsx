import type { Site } from "../../api_types";
import { useText } from "../../i18n";
import { live } from "../../live/live_socket";
import { useStore } from "../../store";
import { Icon } from "../../ui/icon";
import { StateCard } from "../../ui/state_card";

/** Step 4: what is connected, live. */
export function VehicleStep({ site }: { site: Site }) {
  const t = useText();
  const frame = useStore(live.newest);
  const devices = frame?.live.devices ?? [];
  const { length_m, width_m, max_speed_mps } = site.vehicle;
  return (
    <div class="columns scroll">
      <section class="card grow">
        <h2>{t("vehicle.found")}</h2>
        <p>{t("vehicle.size", { length: length_m, width: width_m, speed: max_speed_mps })}</p>
        {devices.length === 0 && <p class="caution">{t("vehicle.none")}</p>}
        <ul class="devices">
          {devices.map((device) => (
            <li key={device.name} class={device.healthy ? "" : "bad"}>
              <Icon name={device.healthy ? "good" : "bad"} />
              <span>
                <strong>{device.name}</strong> ({device.type}) {device.healthy ? t("vehicle.good") : t("vehicle.bad")}
                <small>{device.detail} · {t("live.stale", { age: device.age_s.toFixed(1) })}</small>
              </span>
            </li>
          ))}
        </ul>
      </section>
      <aside><StateCard frame={frame} /></aside>
    </div>
  );
}
