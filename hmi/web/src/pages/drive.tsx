import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../api";
import type { Routes, Session, Site, Walls } from "../api_types";
import { useText } from "../i18n";
import { live, type Frame } from "../live/live_socket";
import type { FactoryMap } from "../map/factory_map";
import { MapView } from "../map/map_view";
import { usePolled, useStore } from "../store";
import { Camera } from "../ui/camera";
import { Gauges } from "../ui/gauges";
import { Icon } from "../ui/icon";
import { Jog } from "../ui/jog";
import { OrdersCard } from "../ui/orders_card";
import { Replay } from "../ui/replay";
import { STALE_S } from "../ui/stale";
import { StateCard } from "../ui/state_card";
import { Tabs, type Tab } from "../ui/tabs";

type TabName = "orders" | "hand" | "replay" | "camera";

function Legend() {
  const t = useText();
  return (
    <ul class="legend" aria-label={t("legend.walls")}>
      {(["confirmed", "displaced", "missing", "unseen"] as const).map((state) => <li key={state}><i class={`wall-${state}`} />{t(`legend.${state}`)}</li>)}
    </ul>
  );
}

/** The operator's page: where the vehicle is, what it does, why it stands, and what to send it next. */
export function DrivePage({ site, walls, routes, role }: { site: Site; walls: Walls; routes: Routes; role: Session["role"] }) {
  const t = useText();
  const map = useRef<FactoryMap | null>(null);
  const [following, setFollowing] = useState(false);
  const [tab, setTab] = useState<TabName>("orders");
  const [back, setBack] = useState(0);
  const replayed = useRef<Frame | null>(null);
  const follow = useRef(false);
  follow.current = following;
  const frame = useStore(live.newest);
  const show = () => {
    const shown = replayed.current ?? live.newest.value;
    if (!shown || !map.current) return;
    const stale = !replayed.current && performance.now() - shown.received_ms > 1000 * STALE_S;
    map.current.live.show({ scan: shown.scan, live: shown.live, vehicle: site.vehicle, stale });
    if (follow.current) map.current.map.getView().setCenter([shown.live.pose.x, shown.live.pose.y]);
  };
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.room = [72, 20, 100, 20];  // the gauges
    made.showSite(site, site.drawing ? api.drawingUrl(site.walls_revision) : null);
    made.showWalls(walls.walls);
    made.fitWalls();
    made.showRoutes(routes);
    show();
    return live.newest.watch(show);
  };
  useEffect(show, [following]);
  const { value: pieces } = usePolled(api.wallsSeen, 5000);
  useEffect(() => map.current?.showSeen(pieces ?? []), [pieces]);
  const may = role === "operator" || role === "integrator";
  const tabs: Tab<TabName>[] = [{ name: "orders", icon: "list", label: t("drive.orders") }];
  if (may) tabs.push({ name: "hand", icon: "hand", label: t("drive.jog") });
  tabs.push({ name: "replay", icon: "history", label: t("drive.replay") });
  if (frame?.live.camera) tabs.push({ name: "camera", icon: "camera", label: t("drive.camera") });
  return (
    <main class="page with-map">
      <MapView ready={ready} above={<>
        <div class="map-top">
          <Gauges frame={frame} />
          {back > 0 && <p class="banner caution" role="status"><Icon name="history" /> {t("drive.replay.banner", { age: back.toFixed(0) })}</p>}
        </div>
        {(pieces ?? []).some((piece) => piece.state !== "unseen") && <Legend />}
      </>}>
        <button type="button" class="target" aria-label={t("drive.follow")} aria-pressed={following} onClick={() => setFollowing(!following)}><Icon name="follow" /></button>
      </MapView>
      <aside>
        <StateCard frame={frame} may={may} />
        <Tabs label={t("drive.tabs")} tabs={tabs} shown={tab} choose={setTab}>
          {tab === "orders" && <OrdersCard nodes={routes.nodes} may={may} />}
          {tab === "hand" && <Jog />}
          {tab === "replay" && <Replay onFrame={(chosen, back_s) => { replayed.current = chosen; setBack(back_s); show(); }} />}
          {tab === "camera" && <Camera />}
        </Tabs>
      </aside>
    </main>
  );
}
