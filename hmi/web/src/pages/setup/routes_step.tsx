import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { Finding, RouteNode, Routes, Site, Walls } from "../../api_types";
import { useText } from "../../i18n";
import type { FactoryMap } from "../../map/factory_map";
import type { XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { EditBar } from "../../ui/edit_bar";
import { Icon } from "../../ui/icon";
import { attempt } from "../../ui/toast";
import { draw, nodeAt, remove, setOneWay, update, type RoutePlan } from "./route_edit";
import { useEdit } from "./use_edit";

const REACH_PX = 28;

function Findings({ findings }: { findings: readonly Finding[] }) {
  const t = useText();
  if (findings.length === 0) return <p role="status"><Icon name="good" /> {t("routes.good")}</p>;
  return (
    <ul class="findings" role="status">
      {findings.map((finding, i) => (
        <li key={i} class={finding.severity === "error" ? "bad" : ""}><Icon name="warning" /> {finding.message}</li>
      ))}
    </ul>
  );
}

const numberOrNull = (text: string) => (text.trim() === "" || !Number.isFinite(Number(text)) ? null : Number(text));

function NodeCard(props: { plan: RoutePlan; node: RouteNode; change: (plan: RoutePlan) => void; removed: () => void }) {
  const t = useText();
  const { plan, node, change } = props;
  const set = (part: Partial<RouteNode>) => change(update(plan, { ...node, ...part }));
  const neighbours = [...new Set(plan.legs.filter((leg) => leg.includes(node.id)).flat())].filter((id) => id !== node.id);
  return (
    <section class="card">
      <label>{t("routes.name")}<input class="target wide" value={node.name} onChange={(e) => set({ name: e.currentTarget.value })} /></label>
      <label>{t("routes.heading")}<input class="target wide" inputMode="decimal" value={node.heading_deg ?? ""} onChange={(e) => set({ heading_deg: numberOrNull(e.currentTarget.value) })} /></label>
      <label>{t("routes.speed")}<input class="target wide" inputMode="decimal" value={node.speed_mps ?? ""} onChange={(e) => set({ speed_mps: numberOrNull(e.currentTarget.value) })} /></label>
      <div class="buttons">
        <button class="target" aria-pressed={node.station} onClick={() => set({ station: !node.station })}>{t("routes.station")}</button>
        <button class="target" onClick={() => { change(remove(plan, node.id)); props.removed(); }}><Icon name="bin" /> {t("routes.delete")}</button>
      </div>
      <div class="buttons">
        {neighbours.map((other) => {
          const back = plan.legs.some(([from, to]) => from === other && to === node.id);
          return (
            <button key={other} class="target" aria-pressed={!back} onClick={() => change(setOneWay(plan, node.id, other, back))}>
              {t("routes.oneway")} {node.id} → {other}
            </button>
          );
        })}
      </div>
    </section>
  );
}

function CsvCard({ imported }: { imported: () => void }) {
  const t = useText();
  const take = async (files: FileList | null) => {
    const named = (part: string) => [...(files ?? [])].find((file) => file.name.includes(part));
    const tree = named("tree");
    const path = named("path");
    if (!tree || !path) return;
    const csv = { revision: "", tree: await tree.text(), path: await path.text() };
    if (await attempt(() => api.importRoutes(csv))) imported();
  };
  return (
    <section class="card buttons">
      <label class="target file">
        {t("routes.import")}
        <input type="file" multiple accept=".csv" onChange={(event) => void take(event.currentTarget.files)} />
      </label>
      <a class="target" href="/api/site/routes/tree.csv" download="tree.csv">tree.csv</a>
      <a class="target" href="/api/site/routes/path.csv" download="path.csv">path.csv</a>
    </section>
  );
}

/** Step 3: routes drawn with a finger, checked while they are drawn. */
export function RoutesStep({ site, walls, routes, changed }: { site: Site; walls: Walls; routes: Routes; changed: () => void }) {
  const t = useText();
  const [drawing, setDrawing] = useState(true);
  const [chosen, setChosen] = useState<number | null>(null);
  const [findings, setFindings] = useState<readonly Finding[]>(routes.findings);
  const map = useRef<FactoryMap | null>(null);
  const edit = useEdit<RoutePlan>({
    site: site.name,
    kind: "routes",
    loaded: { revision: routes.revision, value: { nodes: routes.nodes, legs: routes.legs } },
    save: (revision, value) => api.saveRoutes({ revision, ...value }),
    reload: async () => {
      const theirs = await api.routes();
      return { revision: theirs.revision, value: { nodes: theirs.nodes, legs: theirs.legs } };
    },
  });
  const plan = edit.value;
  const now = useRef({ drawing, chosen, edit });
  now.current = { drawing, chosen, edit };
  useEffect(() => {
    map.current?.showRoutes(plan, chosen === null ? [] : [chosen]);
  }, [plan, chosen]);
  useEffect(() => {
    const timer = setTimeout(() => {
      void api.checkRoutes({ revision: "", ...plan }).then((checked) => setFindings(checked.findings), () => undefined);
    }, 250);
    return () => clearTimeout(timer);
  }, [plan]);

  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    made.showRoutes(plan);
    made.map.on("click", (event) => {
      const reach = REACH_PX * (made.map.getView().getResolution() ?? 1);
      const at = event.coordinate as XY;
      const { drawing: pen, chosen: last, edit: current } = now.current;
      if (pen) {
        const drawn = draw(current.value, last, at, reach);
        current.change(drawn.plan);
        setChosen(drawn.node);
      } else {
        setChosen(nodeAt(current.value, at, reach)?.id ?? null);
      }
    });
  };
  const node = plan.nodes.find((candidate) => candidate.id === chosen);
  const lift = (pen: boolean) => {
    setChosen(null);
    setDrawing(pen);
  };
  return (
    <>
      <MapView ready={ready} />
      <aside>
        <section class="card">
          <p class="quiet">{t("routes.hint")}</p>
          <p>{t("routes.count", { nodes: plan.nodes.length, stations: plan.nodes.filter((n) => n.station).length })}</p>
          <div class="buttons">
            <button class="target" aria-pressed={drawing} onClick={() => lift(true)}>{t("routes.add")}</button>
            <button class="target" aria-pressed={!drawing} onClick={() => lift(false)}>{t("routes.select")}</button>
          </div>
        </section>
        {node && <NodeCard plan={plan} node={node} change={edit.change} removed={() => setChosen(null)} />}
        <section class="card"><Findings findings={findings} /></section>
        <EditBar edit={edit} saved={changed} />
        <CsvCard imported={() => { edit.loadTheirs(); changed(); }} />
      </aside>
    </>
  );
}
