import { useEffect, useState } from "preact/hooks";
import { api } from "../../api";
import type { Mapping, SensorInfo } from "../../api_types";
import { useText } from "../../i18n";
import { deviceName } from "../../notice_text";
import { Icon } from "../../ui/icon";
import { Question } from "../../ui/question";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";
import { Mounted, Shape } from "./vehicle_step";

type Setup = Pick<Mapping, "vehicle" | "sensors">;

/** A name that no other sensor has. */
export function freeSensorName(wanted: string, sensors: readonly SensorInfo[]): string {
  const taken = new Set(sensors.map(({ name }) => name));
  if (!taken.has(wanted)) return wanted;
  for (let number = 2; ; ++number) if (!taken.has(`${wanted}-${number}`)) return `${wanted}-${number}`;
}

/** A drive that was interrupted: it goes on, or is forgotten. */
function Interrupted({ mapping, forget }: { mapping: Mapping; forget: () => void }) {
  const t = useText();
  const [asks, setAsks] = useState(false);
  const goOn = () => void attempt(() => api.startMapping({ vehicle: mapping.vehicle, sensors: mapping.sensors, anew: false }));
  return (
    <div class="centre">
      <h2>{t("mapping.interrupted")}</h2>
      <p>{t("mapping.interrupted.hint")}</p>
      <div class="buttons">
        <Tool icon="next" label={t("mapping.go_on")} primary onClick={goOn} />
        <Tool icon="bin" label={t("mapping.forget")} onClick={() => setAsks(true)} />
      </div>
      {asks && <Question text={t("mapping.forget.sure")} yes={t("mapping.forget")} answer={(yes) => { setAsks(false); if (yes) void attempt(api.dropMapping).then(forget); }} />}
    </div>
  );
}

/** Which vehicle and which lidars map: with the usual ones one touch begins. */
export function MappingStart({ close }: { close: () => void }) {
  const t = useText();
  const [mapping, setMapping] = useState<Mapping | null>(null);
  const [setup, setSetup] = useState<Setup | null>(null);
  const [more, setMore] = useState(false);
  useEffect(() => {
    void attempt(async () => {
      const now = await api.mapping();
      setMapping(now);
      setSetup({ vehicle: now.vehicle, sensors: now.sensors });
    });
  }, []);
  if (!mapping || !setup) return null;
  if (mapping.state === "interrupted") return <Interrupted mapping={mapping} forget={() => setMapping({ ...mapping, state: "none" })} />;
  const setSensor = (at: number, next: SensorInfo | null) =>
    setSetup({ ...setup, sensors: setup.sensors.flatMap((sensor, i) => (i !== at ? [sensor] : next ? [next] : [])) });
  const add = (kind: SensorInfo) => setSetup({ ...setup, sensors: [...setup.sensors, { ...kind, name: freeSensorName(kind.name, setup.sensors) }] });
  return (
    <div class="columns">
      <div class="grow">
        <h2>{t("mapping.lidars")}</h2>
        <div class="buttons kinds">
          {mapping.kinds.map((kind) => <Tool key={kind.type} icon="plus" label={deviceName(t, kind)} onClick={() => kind.sensor && add(kind.sensor)} />)}
        </div>
        {setup.sensors.map((sensor, i) => <Mounted key={i} sensor={sensor} change={(next) => setSensor(i, next)} remove={() => setSensor(i, null)} />)}
        {more && <Shape vehicle={setup.vehicle} change={(vehicle) => setSetup({ ...setup, vehicle })} />}
      </div>
      <aside>
        <p>{t("mapping.start.hint")}</p>
        <p class="facts">{t("vehicle.size", { length: setup.vehicle.length_m, width: setup.vehicle.width_m, speed: setup.vehicle.max_speed_mps })}</p>
        {setup.sensors.length === 0 && <p class="caution" role="status"><Icon name="warning" /> {t("vehicle.no_sensor")}</p>}
        <div class="buttons"><Tool icon="setup" label={t("vehicle.shape")} pressed={more} onClick={() => setMore(!more)} /></div>
        <span class="spring" />
        <div class="buttons finish">
          <Tool icon="hand" label={t("mapping.begin")} primary disabled={setup.sensors.length === 0} onClick={() => void attempt(() => api.startMapping({ ...setup, anew: true }))} />
          <Tool icon="bad" label={t("pad.cancel")} onClick={close} />
        </div>
      </aside>
    </div>
  );
}
