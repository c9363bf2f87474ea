import { useEffect, useRef, useState } from "preact/hooks";
import { api, Refused } from "../../api";
import type { Finding, Routes, Site, Walls } from "../../api_types";
import { useText } from "../../i18n";
import type { FactoryMap } from "../../map/factory_map";
import type { XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { pickOn } from "../../map/pick";
import { EditBar } from "../../ui/edit_bar";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";
import { CsvCard } from "./csv_card";
import { Findings } from "./findings";
import { NodeCard, type NodeTool } from "./node_card";
import { draw, faultyOf, headingTo, nodeAt, update, type RoutePlan } from "./route_edit";
import { useEdit, type Edit } from "./use_edit";

const kReach_px = 28;
const kWorthTeaching_m = 1;

function useRoutes(site: Site, routes: Routes) {
  return useEdit<RoutePlan>({
    site: site.name,
    kind: "routes",
    loaded: { revision: routes.revision, value: { nodes: routes.nodes, legs: routes.legs } },
    save: (revision, { nodes, legs }) => api.saveRoutes({ revision, nodes, legs }),
    reload: async () => {
      const theirs = await api.routes();
      return { revision: theirs.revision, value: { nodes: theirs.nodes, legs: theirs.legs } };
    },
  });
}

/** What is wrong with a plan, asked a moment after its last change. */
function useChecks(plan: RoutePlan, first: readonly Finding[]): readonly Finding[] {
  const [findings, setFindings] = useState<readonly Finding[]>(first);
  useEffect(() => {
    const timer = setTimeout(() => {
      void api.checkRoutes({ revision: "", nodes: plan.nodes, legs: plan.legs }).then((checked) => setFindings(checked.findings), () => undefined);
    }, 250);
    return () => clearTimeout(timer);
  }, [plan]);
  return findings;
}

/** The way driven by hand as a draft: `length_m` of it, and what puts it into the plan. */
function useTeaching(edit: Edit<RoutePlan>, atOnce: boolean) {
  const [length_m, setLength] = useState(0);
  const now = useRef(edit);
  now.current = edit;
  const teach = () =>
    void attempt(async () => {
      const way = await api.drivenWay();
      if (way.length_m < kWorthTeaching_m) throw new Refused(0, "way-too-short", "the way driven by hand is shorter than a metre");
      const { next, ...plan } = now.current.value;
      const { nodes, legs } = await api.teachRoutes({ revision: "", ...plan });
      now.current.change({ next, nodes, legs });
    });
  useEffect(() => {
    void api.drivenWay().then((way) => setLength(way.length_m), () => undefined);
    if (atOnce) teach();
  }, []);
  return { length_m, teach };
}

/** Step 3: routes drawn with a finger, checked while they are drawn. */
export function RoutesStep({ site, walls, routes, teach = false, changed, next }: { site: Site; walls: Walls; routes: Routes; teach?: boolean; changed: () => void; next: () => void }) {
  const t = useText();
  const [drawing, setDrawing] = useState(true);
  const [chosen, setChosen] = useState<number | null>(null);
  const [tool, setTool] = useState<NodeTool>(null);
  const map = useRef<FactoryMap | null>(null);
  const edit = useRoutes(site, routes);
  const plan = edit.value;
  const findings = useChecks(plan, routes.findings);
  const taught = useTeaching(edit, teach);
  const now = useRef({ drawing, chosen, tool, edit });
  now.current = { drawing, chosen, tool, edit };
  useEffect(() => {
    map.current?.showRoutes(plan, chosen === null ? [] : [chosen], faultyOf(findings));
  }, [plan, chosen, findings]);

  const useTool = (at: XY): boolean => {
    const { chosen: id, tool: active, edit: current } = now.current;
    const node = current.value.nodes.find((one) => one.id === id);
    if (!node || !active) return false;
    current.change(update(current.value, active === "move" ? { ...node, x: at[0], y: at[1] } : { ...node, heading_deg: headingTo(node, at) }));
    setTool(null);
    return true;
  };
  const picked = (at: XY, resolution: number) => {
    if (useTool(at)) return;
    const { drawing: pen, chosen: last, edit: current } = now.current;
    const reach = kReach_px * resolution;
    if (!pen) return setChosen(nodeAt(current.value, at, reach)?.id ?? null);
    const drawn = draw(current.value, last, at, reach);
    if (drawn.plan !== current.value) current.change(drawn.plan);
    now.current.chosen = drawn.node;  // at once: the next touch may come before the page is drawn again
    setChosen(drawn.node);
  };
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    made.fitWalls();
    made.showRoutes(plan);
    const nodes = () => now.current.edit.value.nodes.map((node) => [node.x, node.y] as XY);
    return pickOn(made.map, { picked, corners: () => (now.current.tool ? [] : nodes()), active: () => true });
  };
  const node = plan.nodes.find((candidate) => candidate.id === chosen);
  const lift = (pen: boolean) => {
    setChosen(null);
    setTool(null);
    setDrawing(pen);
  };
  return (
    <>
      <MapView ready={ready} />
      <aside>
        {!node && (
          <div class="buttons" role="group" aria-label={t("routes.tools")}>
            <Tool icon="pen" label={t("routes.add")} pressed={drawing} onClick={() => lift(true)} />
            <Tool icon="select" label={t("routes.select")} pressed={!drawing} onClick={() => lift(false)} />
            {taught.length_m >= kWorthTeaching_m && <Tool icon="drive" label={t("routes.teach", { length: taught.length_m.toFixed(0) })} onClick={taught.teach} />}
          </div>
        )}
        {!node && <p class="quiet">{t(!drawing ? "routes.hint.select" : plan.nodes.length < 4 ? "routes.hint" : "routes.hint.short")}</p>}
        <p class="facts">{t("routes.count", { nodes: plan.nodes.length, stations: plan.nodes.filter((one) => one.station).length })}</p>
        <Findings findings={findings} good={t("routes.good")} />
        {node && <NodeCard key={node.id} plan={plan} node={node} tool={tool} setTool={setTool} change={edit.change} close={() => setChosen(null)} />}
        <span class="spring" />
        {!node && <CsvCard saved={routes.nodes.length > 0} imported={() => { edit.loadTheirs(); changed(); }} />}
        <EditBar edit={edit} kind="routes" next={next} />
      </aside>
    </>
  );
}
