import Feature from "ol/Feature";
import { Point } from "ol/geom";
import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { Job, Routes, Site, Walls } from "../../api_types";
import { figure } from "../../figures";
import { useText } from "../../i18n";
import type { FactoryMap } from "../../map/factory_map";
import type { XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { pickOn } from "../../map/pick";
import { corners } from "../../map/snap";
import { EditBar } from "../../ui/edit_bar";
import type { IconName } from "../../ui/icon";
import { AskNumber } from "../../ui/number_pad";
import { Restore } from "../../ui/restore";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";
import { AnotherDrawing, type Revised } from "./another_drawing";
import { JobCard } from "./job_card";
import { MappingStart } from "./mapping_start";
import { RevisionView } from "./revision_view";
import { Upload } from "./upload";
import { useEdit } from "./use_edit";
import { addWall, eraseAt, eraseInside, totalLength, type WallRow } from "./wall_edit";

type ToolName = "look" | "erase" | "area" | "add";
const kReach_px = 24;

interface StepProps {
  site: Site;
  walls: Walls;
  routes: Routes;
  changed: () => Promise<boolean>;
  next: () => void;
}

function useWalls(site: Site, walls: Walls) {
  return useEdit<WallRow[]>({
    site: site.name,
    kind: "walls",
    loaded: { revision: walls.revision, value: walls.walls },
    save: (revision, value) => api.saveWalls({ revision, walls: value.map((w) => w.slice(0, 4) as [number, number, number, number]) }),
    reload: async () => {
      const theirs = await api.walls();
      return { revision: theirs.revision, value: theirs.walls };
    },
  });
}

function Report({ report }: { report: NonNullable<Job["report"]> }) {
  const t = useText();
  const { walls, rejected, skew_deg, notes } = report;
  return (
    <div class="report" role="status">
      <p>{t("drawing.report", { walls, rejected, skew: figure(skew_deg, 1) })}</p>
      {notes.map((note) => <p key={note} class="quiet" lang="en">{note}</p>)}
    </div>
  );
}

/** A PDF's first page is often a title page: another one of the same file. */
function AnotherPage({ read }: { read: (page: number) => void }) {
  const t = useText();
  const [asks, setAsks] = useState(false);
  return (
    <>
      <Tool icon="file" label={t("drawing.page")} onClick={() => setAsks(true)} />
      {asks && <AskNumber label={t("drawing.page.number")} value={null} least={1} most={9999} done={(page) => page !== null && read(Math.round(page))} cancel={() => setAsks(false)} />}
    </>
  );
}

interface EditorProps extends StepProps {
  report: Job["report"];
  /** reads another page of the file that was imported just now, where it has pages */
  readPage: ((page: number) => void) | null;
  revised: (revised: Revised) => void;
  replace: (file: File) => void;
}

function WallEditor({ site, walls, next, report, readPage, revised, replace }: EditorProps) {
  const t = useText();
  const [tool, setTool] = useState<ToolName>("look");
  const map = useRef<FactoryMap | null>(null);
  const first = useRef<XY | null>(null);
  const edit = useWalls(site, walls);
  const now = useRef({ tool, edit, snaps: [] as XY[] });
  now.current.tool = tool;
  now.current.edit = edit;
  useEffect(() => {
    map.current?.showWalls(edit.value);
    now.current.snaps = corners(edit.value, 8 * (site.scale?.m_per_px ?? 1));
  }, [edit.value]);
  const begin = (at: XY | null) => {
    first.current = at;
    map.current?.sketch.clear();
    if (at) map.current?.sketch.addFeature(new Feature(new Point(at)));
  };
  const picked = (at: XY, resolution: number) => {
    const { tool: chosen, edit: current } = now.current;
    const from = first.current;
    if (chosen === "erase") {
      const left = eraseAt(current.value, at, kReach_px * resolution);
      if (left.length !== current.value.length) current.change(left);
    } else if (!from) {
      begin(at);
    } else {
      current.change(chosen === "add" ? addWall(current.value, from, at) : eraseInside(current.value, from, at));
      begin(null);
    }
  };
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(edit.value);
    made.fitWalls();
    return pickOn(made.map, {
      picked,
      corners: () => (now.current.tool === "add" ? now.current.snaps : []),
      active: () => now.current.tool !== "look",
    });
  };
  const choose = (name: ToolName, icon: IconName, label: string) => (
    <Tool icon={icon} label={label} pressed={tool === name} onClick={() => { begin(null); setTool(name); }} />
  );
  const length = totalLength(edit.value).toFixed(0);
  return (
    <>
      <MapView ready={ready} />
      <aside>
        <p class="facts">{t("drawing.found", { walls: edit.value.length })}<br />{t(site.scale ? "drawing.length.m" : "drawing.length.px", { length })}</p>
        {report && <Report report={report} />}
        <div class="buttons" role="group" aria-label={t("drawing.tools")}>
          {choose("look", "move", t("drawing.look"))}
          {choose("erase", "erase", t("drawing.erase"))}
          {choose("area", "select", t("drawing.area"))}
          {choose("add", "pen", t("drawing.add"))}
          <AnotherDrawing revised={revised} replace={replace} />
          {readPage && <AnotherPage read={readPage} />}
        </div>
        <p class="quiet">{t(`drawing.hint.${tool}`)}</p>
        <span class="spring" />
        <EditBar edit={edit} kind="walls" next={next} />
      </aside>
    </>
  );
}

/** Step 1: a drawing file becomes walls, which a person may mend; another one is looked at before it is taken over. */
export function DrawingStep(props: StepProps) {
  const t = useText();
  const { site, changed } = props;
  const [job, setJob] = useState<Job | null>(null);
  const [working, setWorking] = useState(false);
  const [revised, setRevised] = useState<Revised | null>(null);
  const [mapping, setMapping] = useState(false);
  const [imports, setImports] = useState(0);
  const [sent, setSent] = useState<File | null>(null);
  const done = (finished: Job) => {
    setJob(finished);
    void changed().then((came) => came && setImports((count) => count + 1));  // the editor keeps the walls that it began with
  };
  const send = (file: File, options: Record<string, string> = {}) => {
    setRevised(null);
    setSent(file);
    void attempt(() => api.uploadDrawing(file, options)).then(setWorking);
  };
  const close = (taken: boolean) => {
    setRevised(null);
    if (taken) void changed();
  };
  if (working) return <div class="centre"><JobCard kind="import" done={done} ended={() => setWorking(false)} /></div>;
  if (!site.drawing && mapping) return <MappingStart close={() => setMapping(false)} />;
  if (!site.drawing) {
    return (
      <div class="centre">
        <h2>{t("drawing.none")}</h2>
        <Upload send={send} />
        <div class="buttons">
          <Restore over={false} done={() => void changed()} />
          <Tool icon="hand" label={t("mapping.offer")} onClick={() => setMapping(true)} />
        </div>
      </div>
    );
  }
  if (revised)
    return <RevisionView {...props} name={revised.file.name} preview={revised.preview} laid={(preview) => setRevised({ ...revised, preview })} asNew={() => send(revised.file)} close={close} />;
  const readPage = sent && /\.pdf$/i.test(sent.name) ? (page: number) => send(sent, { page: String(page) }) : null;
  return <WallEditor key={`${site.drawing.file}${site.drawing.width_px}/${imports}`} {...props} report={job?.report ?? null} readPage={readPage} revised={setRevised} replace={send} />;
}
