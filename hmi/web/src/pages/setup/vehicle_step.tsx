import { useState } from "preact/hooks";
import { api } from "../../api";
import type { FoundDevice, SensorInfo, Site, VehicleInfo } from "../../api_types";
import { noticeText, useText } from "../../i18n";
import { live } from "../../live/live_socket";
import { deviceName } from "../../notice_text";
import { usePolled, useStore } from "../../store";
import { Icon } from "../../ui/icon";
import { NumberField } from "../../ui/number_pad";
import { Stale } from "../../ui/stale";
import { Tool } from "../../ui/tool";
import { EditBar } from "../../ui/edit_bar";
import { BrakingCard } from "./braking_card";
import { attempt } from "../../ui/toast";
import { LidarViews } from "./lidar_views";
import { MountingCard } from "./mounting_card";
import { useEdit } from "./use_edit";

type Plan = Pick<Site, "vehicle" | "sensors" | "route_metric">;

const planOf = ({ vehicle, sensors, route_metric }: Site): Plan => ({ vehicle, sensors, route_metric });
const metrics: readonly Plan["route_metric"][] = ["hops", "metres"];

type Dimension = keyof VehicleInfo;
const dimensions: readonly [Dimension, number, number, string][] = [
  ["length_m", 0.2, 5, "m"], ["width_m", 0.2, 3, "m"], ["height_m", 0.1, 4, "m"], ["base_to_rear_m", 0, 4, "m"],
  ["wheel_radius_m", 0.01, 1, "m"], ["half_wheel_separation_m", 0.05, 2, "m"],
  ["max_speed_mps", 0.05, 3, "m/s"], ["max_acceleration_mps2", 0.05, 3, "m/s²"], ["max_turn_rate_radps", 0.05, 3, "rad/s"],
  ["max_deceleration_mps2", 0.05, 5, "m/s²"], ["max_turn_acceleration_radps2", 0.05, 10, "rad/s²"], ["reaction_s", 0, 2, "s"],
];
const mounting: readonly ["x_m" | "y_m" | "z_m" | "yaw_deg", number, number, string][] = [
  ["x_m", -5, 5, "m"], ["y_m", -5, 5, "m"], ["z_m", 0, 5, "m"], ["yaw_deg", -180, 180, "°"],
];

/** What is heard on the network and the serial ports; one tap mounts a sensor. */
function Found({ plan, use }: { plan: Plan; use: (sensor: SensorInfo) => void }) {
  const t = useText();
  const { value, age_s } = usePolled(api.devices, 1000);
  const devices = useStore(live.newest)?.live.devices ?? [];
  const [searched, setSearched] = useState<FoundDevice[] | "searching" | null>(null);
  const search = () => {
    setSearched("searching");
    void attempt(async () => setSearched(await api.searchDevices())).then((worked) => worked || setSearched(null));
  };
  const fresh = Array.isArray(searched) ? searched.filter(({ sensor }) => !sensor || !plan.sensors.some(({ name }) => name === sensor.name)) : [];
  const used = (device: FoundDevice) => plan.sensors.some((sensor) => sensor.type === device.type);
  return (
    <section class="grow">
      <h2>{t("vehicle.found")}</h2>
      <Stale age={age_s} limit={3} />
      {(value ?? []).length === 0 && <p class="caution"><Icon name="warning" /> {t("vehicle.none")}</p>}
      <ul class="devices">
        {(value ?? []).map((device) => {
          const state = devices.find((one) => one.type === device.type);
          return (
            <li key={device.type + device.address} class={device.heard ? "" : "bad"}>
              <Icon name={device.heard ? "good" : "bad"} />
              <span>
                <strong>{deviceName(t, device)}</strong> {t(device.heard ? "vehicle.heard" : "vehicle.silent")}
                <small>{device.address} {!["heard", "silent"].includes(device.detail.code) && noticeText(t, "device", device.detail)}</small>
                {state && <small>{state.rate_hz !== null && t("vehicle.rate", { rate: state.rate_hz.toFixed(1) })} {noticeText(t, "device", state.detail)} <Stale age={state.age_s} /></small>}
              </span>
              {device.sensor && (used(device)
                ? <span class="quiet">{t("vehicle.used")}</span>
                : <Tool icon="plus" label={t("vehicle.use")} primary onClick={() => device.sensor && use(device.sensor)} />)}
            </li>
          );
        })}
        {fresh.map((device) => (
          <li key={device.type + device.address}>
            <Icon name="good" />
            <span><strong>{deviceName(t, device)}</strong> {t("vehicle.heard")}<small>{device.address}</small></span>
            {device.sensor && <Tool icon="plus" label={t("vehicle.use")} primary onClick={() => device.sensor && use(device.sensor)} />}
          </li>
        ))}
      </ul>
      {searched === "searching" && <p role="status">{t("vehicle.searching")}</p>}
      {Array.isArray(searched) && fresh.length === 0 && <p role="status">{t("vehicle.search_none")}</p>}
      <div class="buttons"><Tool icon="search" label={t("vehicle.search")} disabled={searched === "searching"} onClick={search} /></div>
    </section>
  );
}

/** The numbers of the vehicle. */
export function Shape({ vehicle, change }: { vehicle: VehicleInfo; change: (next: VehicleInfo) => void }) {
  const t = useText();
  return (
    <>
      <h2>{t("vehicle.shape")}</h2>
      <div class="buttons">
        {dimensions.map(([key, least, most, unit]) => (
          <NumberField key={key} label={t(`vehicle.${key}`)} value={vehicle[key]} unit={unit} least={least} most={most}
            change={(value) => value !== null && change({ ...vehicle, [key]: value })} />
        ))}
      </div>
    </>
  );
}

export function Mounted({ sensor, change, remove }: { sensor: SensorInfo; change: (next: SensorInfo) => void; remove: () => void }) {
  const t = useText();
  return (
    <section class="mounted">
      <h3>{sensor.name} ({sensor.type})</h3>
      <div class="buttons">
        {mounting.map(([key, least, most, unit]) => (
          <NumberField key={key} label={t(`mount.${key}`)} value={sensor[key]} unit={unit} least={least} most={most} change={(value) => change({ ...sensor, [key]: value ?? 0 })} />
        ))}
        <Tool icon="bin" label={t("vehicle.remove")} onClick={remove} />
      </div>
    </section>
  );
}

/** Step 4: sensors and drive found and shown live; the vehicle's shape. */
export function VehicleStep({ site, next }: { site: Site; next: () => void }) {
  const t = useText();
  const [more, setMore] = useState(false);
  const [brakes, setBrakes] = useState(false);
  const edit = useEdit<Plan>({
    site: site.name,
    kind: "vehicle",
    loaded: { revision: site.vehicle_revision, value: planOf(site) },
    save: (revision, value) => api.saveVehicle({ revision, ...value }),
    reload: async () => {
      const theirs = await api.site();
      return { revision: theirs.vehicle_revision, value: planOf(theirs) };
    },
  });
  const plan = edit.value;
  const setSensor = (at: number, next: SensorInfo | null) =>
    edit.change({ ...plan, sensors: plan.sensors.flatMap((sensor, i) => (i !== at ? [sensor] : next ? [next] : [])) });
  /** What was not found is as typed; who was not measured stays as it is. */
  const takeOver = (found: SensorInfo[]) => {
    edit.change({ ...plan, sensors: plan.sensors.map((sensor) => ({ ...sensor, ...found.find(({ name }) => name === sensor.name) })) });
    setMore(true);
  };
  return (
    <div class="columns">
      <div class="grow">
        <Found plan={plan} use={(sensor) => edit.change({ ...plan, sensors: [...plan.sensors, sensor] })} />
        {brakes && (
          <BrakingCard record={plan.vehicle} takeOver={(measured) => {
            edit.change({ ...plan, vehicle: { ...plan.vehicle, ...measured } });
            void edit.save();
          }} />
        )}
        <LidarViews vehicle={plan.vehicle} />
        {plan.sensors.length > 0 && <MountingCard saved={!edit.unsaved} take={takeOver} />}
        {more && (
          <>
            <Shape vehicle={plan.vehicle} change={(vehicle) => edit.change({ ...plan, vehicle })} />
            <h2>{t("vehicle.routes")}</h2>
            <div class="buttons">
              {metrics.map((metric) => (
                <Tool key={metric} icon={metric === "hops" ? "oneway" : "ruler"} label={t(`vehicle.routes.${metric}`)} pressed={plan.route_metric === metric}
                  onClick={() => edit.change({ ...plan, route_metric: metric })} />
              ))}
            </div>
            {plan.sensors.map((sensor, i) => <Mounted key={i} sensor={sensor} change={(changedSensor) => setSensor(i, changedSensor)} remove={() => setSensor(i, null)} />)}
          </>
        )}
      </div>
      <aside>
        <p class="facts">{t("vehicle.size", { length: plan.vehicle.length_m, width: plan.vehicle.width_m, speed: plan.vehicle.max_speed_mps })}</p>
        <ul class="facts">{plan.sensors.map((sensor) => <li key={sensor.name}>{t("vehicle.mounted", { name: sensor.name, type: sensor.type, height: sensor.z_m })}</li>)}</ul>
        {plan.sensors.length === 0 && <p class="caution" role="status"><Icon name="warning" /> {t("vehicle.no_sensor")}</p>}
        <div class="buttons"><Tool icon="setup" label={t("vehicle.details")} pressed={more} onClick={() => setMore(!more)} />
          <Tool icon="ruler" label={t("braking.measure")} pressed={brakes} onClick={() => setBrakes(!brakes)} />
        </div>
        <span class="spring" />
        <EditBar edit={edit} kind="vehicle" next={next} />
      </aside>
    </div>
  );
}
