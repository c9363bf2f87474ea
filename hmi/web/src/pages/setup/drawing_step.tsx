import Feature from "ol/Feature";
import { Point } from "ol/geom";
import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { Job, Site, Walls } from "../../api_types";
import { useText } from "../../i18n";
import type { FactoryMap } from "../../map/factory_map";
import { distanceToSegment, type XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { EditBar } from "../../ui/edit_bar";
import { attempt, tell } from "../../ui/toast";
import { useEdit } from "./use_edit";

type Tool = "look" | "erase" | "add";
const REACH_PX = 24;

function Upload({ done }: { done: () => void }) {
  const t = useText();
  const [job, setJob] = useState<Job | null>(null);
  const input = useRef<HTMLInputElement>(null);
  const follow = async () => {
    for (;;) {
      const state = await api.job();
      setJob(state);
      if (!state.running) {
        setJob(null);
        if (state.error !== "") tell("import", state.error);
        else done();
        return;
      }
      await new Promise((resolve) => setTimeout(resolve, 300));
    }
  };
  const take = (file: File | undefined) => {
    if (file) void attempt(() => api.uploadDrawing(file)).then((started) => (started ? follow() : undefined));
  };
  if (job) {
    return (
      <section class="card" aria-live="polite">
        <p>{t("drawing.working", { stage: job.stage })}</p>
        <progress value={job.share} max={1} aria-label={job.stage} />
      </section>
    );
  }
  return (
    <section class="card drop" onDragOver={(event) => event.preventDefault()}
      onDrop={(event) => { event.preventDefault(); take(event.dataTransfer?.files[0]); }}>
      <p>{t("drawing.hint")}</p>
      <input ref={input} type="file" hidden accept=".dxf,.pdf,.png,.jpg,.jpeg,.tif,.tiff,.bmp,.svg"
        onChange={(event) => take(event.currentTarget.files?.[0])} />
      <button class="target primary wide" onClick={() => input.current?.click()}>{t("drawing.choose")}</button>
    </section>
  );
}

const lengthOf = (walls: readonly number[][]) =>
  walls.reduce((sum, [x1 = 0, y1 = 0, x2 = 0, y2 = 0]) => sum + Math.hypot(x2 - x1, y2 - y1), 0);

function WallEditor({ site, walls, changed }: { site: Site; walls: Walls; changed: () => void }) {
  const t = useText();
  const [tool, setTool] = useState<Tool>("look");
  const map = useRef<FactoryMap | null>(null);
  const first = useRef<XY | null>(null);
  const edit = useEdit<number[][]>({
    site: site.name,
    kind: "walls",
    loaded: { revision: walls.revision, value: walls.walls },
    save: (revision, value) => api.saveWalls({ revision, walls: value.map((w) => w.slice(0, 4) as [number, number, number, number]) }),
    reload: async () => {
      const theirs = await api.walls();
      return { revision: theirs.revision, value: theirs.walls };
    },
  });
  const current = useRef({ tool, edit });
  current.current = { tool, edit };
  useEffect(() => map.current?.showWalls(edit.value), [edit.value]);

  const tap = (at: XY, resolution: number) => {
    const { tool: chosen, edit: now } = current.current;
    if (chosen === "erase") {
      const distances = now.value.map((wall) => distanceToSegment(at, wall));
      const nearest = distances.indexOf(Math.min(...distances));
      if ((distances[nearest] ?? Infinity) <= REACH_PX * resolution) now.change(now.value.filter((_, i) => i !== nearest));
    } else if (chosen === "add") {
      if (first.current === null) {
        first.current = at;
        map.current?.sketch.addFeature(new Feature(new Point(at)));
      } else {
        now.change([...now.value, [...first.current, ...at, -1]]);
        first.current = null;
        map.current?.sketch.clear();
      }
    }
  };
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(edit.value);
    made.map.on("click", (event) => tap(event.coordinate as XY, made.map.getView().getResolution() ?? 1));
  };
  const choose = (name: Tool, label: string) => (
    <button class="target" aria-pressed={tool === name} onClick={() => { first.current = null; map.current?.sketch.clear(); setTool(name); }}>{label}</button>
  );
  return (
    <>
      <MapView ready={ready} />
      <aside>
        <section class="card">
          <p>{t("drawing.found", { walls: edit.value.length, length: `${lengthOf(edit.value).toFixed(0)} ${site.scale ? "m" : "px"}` })}</p>
          <div class="buttons">
            {choose("look", t("drawing.look"))}
            {choose("erase", t("drawing.erase"))}
            {choose("add", t("drawing.add"))}
          </div>
        </section>
        <EditBar edit={edit} saved={changed} />
        <Upload done={changed} />
      </aside>
    </>
  );
}

/** Step 1: a drawing file becomes walls, which a person may mend. */
export function DrawingStep({ site, walls, changed }: { site: Site; walls: Walls; changed: () => void }) {
  const t = useText();
  if (!site.drawing) {
    return (
      <div class="centre">
        <h2>{t("drawing.none")}</h2>
        <Upload done={changed} />
      </div>
    );
  }
  return <WallEditor key={site.drawing.file + site.drawing.width_px} site={site} walls={walls} changed={changed} />;
}
