import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../api";
import type { Routes, Session, Site, Walls } from "../api_types";
import { useText } from "../i18n";
import { live, type Frame } from "../live/live_socket";
import type { FactoryMap } from "../map/factory_map";
import { MapView } from "../map/map_view";
import { usePlacing } from "../map/use_placing";
import { usePolled, useSelected, useStore } from "../store";
import { faultyOf } from "./setup/route_edit";
import { Camera } from "../ui/camera";
import { DrivePad } from "../ui/drive_pad";
import { Gauges, heardAgo } from "../ui/gauges";
import { Icon } from "../ui/icon";
import { Jog } from "../ui/jog";
import { OrdersCard } from "../ui/orders_card";
import { Replay } from "../ui/replay";
import { STALE_S, Stale, useAge } from "../ui/stale";
import { StateCard, kLost_s } from "../ui/state_card";
import { Tabs, type Tab } from "../ui/tabs";
import { Tool } from "../ui/tool";
import { WhereCard } from "../ui/where_card";

const kLate_ms = 250;

type TabName = "orders" | "hand" | "replay" | "camera";

function Legend() {
  const t = useText();
  return (
    <ul class="legend" aria-label={t("legend.walls")}>
      {(["confirmed", "displaced", "missing", "unseen"] as const).map((state) => <li key={state}><i class={`wall-${state}`} />{t(`legend.${state}`)}</li>)}
    </ul>
  );
}

/** Says on the map that the scan or all of it is of before, or that nobody knows where the vehicle is. */
function OldBanner({ frame, back }: { frame: Frame | null; back: number }) {
  const t = useText();
  const age_s = useAge(frame);
  const lidar_s = heardAgo(frame, "lidar", age_s);
  const banner = (name: string, text: string, age?: number) => <p class="banner caution" role="status" data-banner={name}><Icon name="warning" /> {text} {age !== undefined && <Stale age={age} />}</p>;
  if (back > 0) return <p class="banner caution" role="status"><Icon name="history" /> {t("drive.replay.banner", { age: back.toFixed(0) })}</p>;
  if (!frame) return null;
  if (age_s > kLost_s) return banner("old", t("drive.old"), age_s);
  if (lidar_s > STALE_S) return banner("no-scan", t("drive.no_scan"), lidar_s);
  return frame.live.drivable && frame.live.pose.health === "LOST" ? banner("lost", t("drive.lost")) : null;
}

/** What changes ten times a second: drawn by itself, so that the page around it is not. */
const Newest = ({ children }: { children: (frame: Frame | null) => ComponentChildren }) => <>{children(useStore(live.newest))}</>;

/** The operator's page: where the vehicle is, what it does, why it stands, and what to send it next. */
export function DrivePage({ site, walls, routes, role, changed, teach }: { site: Site; walls: Walls; routes: Routes; role: Session["role"]; changed: () => Promise<unknown>; teach: () => void }) {
  const t = useText();
  const map = useRef<FactoryMap | null>(null);
  const [following, setFollowing] = useState(false);
  const [tab, setTab] = useState<TabName>("orders");
  const [back, setBack] = useState(0);
  const replayed = useRef<Frame | null>(null);
  const follow = useRef(false);
  follow.current = following;
  const camera = useSelected(live.newest, (frame) => frame?.live.camera ?? false);
  const [asking, setAsking] = useState(false);
  const placing = usePlacing(site, walls.walls, asking);
  const asked = useRef(asking);
  asked.current = asking;
  const show = () => {
    if (asked.current) return;
    const shown = replayed.current ?? live.newest.value;
    if (!shown || !map.current) return;
    const age = (performance.now() - shown.received_ms) / 1000;
    const stale = !replayed.current && age > kLost_s;
    const known = shown.live.drivable && shown.live.pose.health !== "LOST";
    const scanYoung = replayed.current !== null || stale || heardAgo(shown, "lidar", age) <= STALE_S;
    map.current.live.show({ scan: shown.scan, live: shown.live, vehicle: site.vehicle, stale, vehicleShown: known, scanShown: known && scanYoung });
    if (follow.current && known) map.current.map.getView().setCenter([shown.live.pose.x, shown.live.pose.y]);
  };
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.room = [72, 20, 100, 20];  // the gauges
    made.showSite(site, site.drawing ? api.drawingUrl(site.walls_revision) : null);
    made.showWalls(walls.walls);
    made.fitWalls();
    made.showRoutes(routes, [], faultyOf(routes.findings));
    show();
    const unwatch = live.newest.watch(show);
    const end = placing.attach(made);
    return () => {
      unwatch();
      end();
    };
  };
  useEffect(() => {
    show();
    const timer = setInterval(() => performance.now() - (live.newest.value?.received_ms ?? 0) > kLate_ms && show(), kLate_ms);  // it grows old without a message
    return () => clearInterval(timer);
  }, [following, asking]);
  const { value: pieces } = usePolled(api.wallsSeen, 5000);
  const look = (pieces ?? []).map(({ segment, state }) => `${state} ${segment.join()}`).join();  // a share that changed is not seen
  useEffect(() => map.current?.showSeen(pieces ?? []), [look]);
  const may = role === "operator" || role === "integrator";
  const tabs: Tab<TabName>[] = [{ name: "orders", icon: "list", label: t("drive.orders") }];
  if (may) tabs.push({ name: "hand", icon: "hand", label: t("drive.jog") });
  tabs.push({ name: "replay", icon: "history", label: t("drive.replay") });
  const byHand = may && tab === "hand" && !asking;
  if (camera) tabs.push({ name: "camera", icon: "camera", label: t("drive.camera") });
  return (
    <main class="page with-map">
      <MapView ready={ready} above={<>
        <div class="map-top">
          <Newest>{(frame) => <Gauges frame={frame} />}</Newest>
          {asking && placing.byHand ? <p class="banner card" role="status">{t("locate.hint.hand")}</p> : <Newest>{(frame) => <OldBanner frame={frame} back={back} />}</Newest>}
        </div>
        {byHand && <DrivePad />}
        {!byHand && (pieces ?? []).some((piece) => piece.state !== "unseen") && <Legend />}
      </>}>
        <button type="button" class="target" aria-label={t("drive.follow")} aria-pressed={following} onClick={() => setFollowing(!following)}><Icon name="follow" /></button>
        <button type="button" class="target where-button" aria-pressed={asking} onClick={() => setAsking(!asking)}><Icon name="pin" /> {t("where.title")}</button>
      </MapView>
      <aside>
        <Newest>{(frame) => <StateCard frame={frame} />}</Newest>
        {asking && <WhereCard placing={placing} role={role} walls={walls} changed={() => void changed()} close={() => setAsking(false)} />}
        {!asking && <Tabs label={t("drive.tabs")} tabs={tabs} shown={tab} choose={setTab}>
          {tab === "orders" && <OrdersCard nodes={routes.nodes} may={may} />}
          {tab === "hand" && <Jog corner={role === "integrator" && <Tool icon="drive" label={t("routes.teach_this")} onClick={teach} />} />}
          {tab === "replay" && <Replay onFrame={(chosen, back_s) => { replayed.current = chosen; setBack(back_s); show(); }} />}
          {tab === "camera" && <Camera />}
        </Tabs>}
      </aside>
    </main>
  );
}
