import { api } from "../../api";
import type { LidarView, VehicleInfo } from "../../api_types";
import { noticeText, useText } from "../../i18n";
import { usePolled } from "../../store";
import { Icon } from "../../ui/icon";
import { Stale } from "../../ui/stale";

/** Half the edge of a view, metres. */
const reach_m = 8;

/** The newest sweep from above, forward is up, with the vehicle's outline. */
function TopView({ lidar, vehicle }: { lidar: LidarView; vehicle: VehicleInfo }) {
  const t = useText();
  const dots: string[] = [];
  for (let i = 0; i + 1 < lidar.points.length; i += 2) {
    const x = lidar.points[i] ?? 0;
    const y = lidar.points[i + 1] ?? 0;
    if (Math.abs(x) < reach_m && Math.abs(y) < reach_m) dots.push(`M${(-y).toFixed(2)} ${(-x).toFixed(2)}h0`);
  }
  const front_m = vehicle.length_m - vehicle.base_to_rear_m;
  return (
    <svg class="topview" role="img" aria-label={t("views.alt", { name: lidar.name })} viewBox={`${-reach_m} ${-reach_m} ${2 * reach_m} ${2 * reach_m}`}>
      <rect class="outline" x={-vehicle.width_m / 2} y={-front_m} width={vehicle.width_m} height={vehicle.length_m} />
      <path class="ahead" d={`M0 ${-front_m}v-0.8m-0.3 0.3l0.3-0.3l0.3 0.3`} />
      <path class="dots" d={dots.join("")} />
    </svg>
  );
}

/** What each lidar sees now: its newest sweep, its rate, what it lost, and what is wrong with it. */
export function LidarViews({ vehicle }: { vehicle: VehicleInfo }) {
  const t = useText();
  const { value, age_s } = usePolled(api.lidarViews, 500);
  if (!value || value.length === 0) return null;
  return (
    <section class="views">
      <h2>{t("views.title")}</h2>
      <Stale age={age_s} limit={3} />
      <ul>
        {value.map((lidar) => {
          const good = lidar.state.code === "heard";
          return (
            <li key={lidar.name} class={good ? "" : "bad"}>
              <TopView lidar={lidar} vehicle={vehicle} />
              <strong><Icon name={good ? "good" : "bad"} /> {lidar.name}</strong>
              <small>{lidar.place}</small>
              <small>{t("views.rate", { rate: lidar.rate_hz.toFixed(1), lost: lidar.lost, refused: lidar.refused })}</small>
              {!good && <small>{noticeText(t, "view", lidar.state)}</small>}
            </li>
          );
        })}
      </ul>
    </section>
  );
}
