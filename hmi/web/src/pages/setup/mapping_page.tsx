import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { Mapping } from "../../api_types";
import { noticeText, useText } from "../../i18n";
import { live } from "../../live/live_socket";
import { parseScan } from "../../live/scan_frame";
import type { FactoryMap } from "../../map/factory_map";
import { MapView } from "../../map/map_view";
import { usePolled } from "../../store";
import { DrivePad } from "../../ui/drive_pad";
import { Icon } from "../../ui/icon";
import { Jog } from "../../ui/jog";
import { Question } from "../../ui/question";
import { STALE_S, Stale } from "../../ui/stale";
import { StateCard, kLost_s } from "../../ui/state_card";
import { useStore } from "../../store";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";
import { heardAgo } from "../../ui/gauges";
import { JobCard } from "./job_card";

/** The map so far: asked for again whenever the mapper has drawn it anew. */
function useGrowingMap(map: { current: FactoryMap | null }, mapping: Mapping | null) {
  useEffect(() => {
    if (!mapping || mapping.revision === 0) return;
    map.current?.showWalls(mapping.walls);
    void api.mappingPoints().then((frame) => {
      const seen = parseScan(frame);
      if (seen) map.current?.showPoints(seen.points);
    }, () => undefined);
  }, [mapping?.revision]);
}

function Facts({ mapping, age_s }: { mapping: Mapping | null; age_s: number }) {
  const t = useText();
  if (!mapping) return null;
  const { driven_m, keyframes, loops, problem, state } = mapping;
  return (
    <div class="map-top" data-mapping={state} data-driven={driven_m.toFixed(1)}>
      <p class="banner card" role="status">{t(state === "reading" ? "mapping.reading" : "mapping.facts", { driven: driven_m.toFixed(0), places: keyframes, loops })} <Stale age={age_s} limit={3} /></p>
      {problem.text !== "" && <p class="banner caution" role="status" data-problem={problem.code}><Icon name="warning" /> {noticeText(t, "error", problem)}</p>}
    </div>
  );
}

/** No drawing: the vehicle is driven by hand, and the map grows. */
export function MappingPage() {
  const t = useText();
  const map = useRef<FactoryMap | null>(null);
  const { value: mapping, age_s } = usePolled(api.mapping, 1000);
  const vehicle = useRef(mapping?.vehicle);
  vehicle.current = mapping?.vehicle;
  const [asks, setAsks] = useState(false);
  const [finishing, setFinishing] = useState(false);
  const connected = useStore(live.connected);
  useGrowingMap(map, mapping);
  const show = () => {
    const frame = live.newest.value;
    if (!frame || !vehicle.current || !map.current) return;
    const age = (performance.now() - frame.received_ms) / 1000;
    const stale = age > kLost_s;
    map.current.live.show({ scan: frame.scan, live: frame.live, vehicle: vehicle.current, stale, vehicleShown: true, scanShown: stale || heardAgo(frame, "lidar", age) <= STALE_S });
    map.current.keepInView([frame.live.pose.x, frame.live.pose.y]);
  };
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.room = [90, 40, 130, 40];
    made.showGrowing();
    return live.newest.watch(show);
  };
  const finish = () => void attempt(api.finishMapping).then(setFinishing);
  const busy = finishing || mapping?.state === "finishing";
  return (
    <main class="page with-map">
      <MapView ready={ready} above={<><Facts mapping={mapping} age_s={age_s} /><DrivePad /></>}>
        <button type="button" class="target" aria-label={t("mapping.give_up")} onClick={() => setAsks(true)}><Icon name="bin" /></button>
      </MapView>
      <aside>
        <StateCard frame={useStore(live.newest)} />
        {busy
          ? <JobCard kind="mapping" done={() => undefined} ended={() => setFinishing(false)} />
          : <Jog hint={false} corner={<Tool icon="good" label={t("mapping.finish")} primary disabled={!connected || mapping?.state !== "mapping"} onClick={finish} />} />}
        <p class="quiet">{t("mapping.hint")}</p>
      </aside>
      {asks && <Question text={t("mapping.give_up.sure")} yes={t("mapping.give_up")} answer={(yes) => { setAsks(false); if (yes) void attempt(api.dropMapping); }} />}
    </main>
  );
}
