import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { Routes, Setup, Site, Walls } from "../../api_types";
import { noticeText, useText } from "../../i18n";
import { live } from "../../live/live_socket";
import { usePolled, useSelected, useStore } from "../../store";
import { Icon } from "../../ui/icon";
import { Watch } from "../../ui/watch";
import { DrawingStep } from "./drawing_step";
import { LocateStep } from "./locate_step";
import { MappingPage } from "./mapping_page";
import { RoutesStep } from "./routes_step";
import { ScaleStep } from "./scale_step";
import { VehicleStep } from "./vehicle_step";

const steps = ["drawing", "scale", "routes", "vehicle", "locate"] as const;
type Step = (typeof steps)[number];

/** Where a person who comes back goes on. */
function firstOpen(site: Site, routes: Routes): Step {
  if (!site.drawing) return "drawing";
  if (!site.scale) return "scale";
  if (routes.nodes.length === 0) return "routes";
  return site.sensors.length === 0 ? "vehicle" : "locate";
}

function isOpen(step: Step, site: Site): boolean {
  if (step === "drawing" || step === "vehicle") return true;
  return site.drawing !== null && (step === "scale" || site.scale !== null);
}

function StepBar({ shown, site, setup, choose }: { shown: Step; site: Site; setup: Setup | null; choose: (step: Step) => void }) {
  const t = useText();
  return (
    <nav class="steps" aria-label={t("nav.setup")}>
      {steps.map((name, i) => {
        const state = setup?.steps.find((step) => step.name === name);
        const faulty = ["routes-through-wall", "faulty-routes"].includes(state?.what.code ?? "");
        const done = (state?.done ?? false) && !faulty;
        return (
          <button key={name} type="button" class="target" aria-current={name === shown ? "step" : undefined} disabled={!isOpen(name, site)} data-done={done} onClick={() => choose(name)}>
            {done ? <Icon name="good" /> : faulty ? <Icon name="warning" /> : <b>{i + 1}</b>}
            <span>{t(`setup.${name}`)}</span>
            {done && <span class="unseen">{t("setup.done")}</span>}
            {faulty && state && <span class="unseen">{noticeText(t, "setup", state.what)}</span>}
          </button>
        );
      })}
    </nav>
  );
}

interface Props {
  site: Site;
  walls: Walls;
  routes: Routes;
  /** loads the site anew; the next step begins with what has come. False where nothing came. */
  changed: () => Promise<boolean>;
  finished: () => void;
  /** the way just driven shall become routes */
  teach?: boolean;
}

/** The five steps; they can be left and resumed, also on another panel. */
export function SetupPage({ site, walls, routes, changed, finished, teach = false }: Props) {
  const t = useText();
  const [step, setStep] = useState<Step>(teach ? "routes" : firstOpen(site, routes));
  const wasMapping = useRef(false);
  const { value: setup } = usePolled(api.setup, 2000);
  const locked = useStore(live.newest)?.live.locked;
  const mapping = useSelected(live.newest, (frame) => frame?.live.mapping ?? false);
  const open = firstOpen(site, routes);
  useEffect(() => setStep((old) => (old === "drawing" && open !== "drawing" && wasMapping.current ? open : old)), [open]);
  wasMapping.current ||= mapping;
  const next = () => setStep(steps[steps.indexOf(step) + 1] ?? "locate");
  /** Not at once: the next step would begin on what was before, and a quick touch go there. */
  const saved = () => void changed().then((came) => came && next());
  if (mapping && !site.drawing) return <MappingPage />;
  return (
    <main class="page">
      <StepBar shown={step} site={site} setup={setup} choose={setStep} />
      {locked && locked.text !== "" && <p class="caution locked" role="status"><Icon name="warning" /> {noticeText(t, "error", locked)}</p>}
      <div class="with-map step" key={step}>
        {step === "drawing" && <DrawingStep site={site} walls={walls} routes={routes} changed={changed} next={saved} />}
        {step === "scale" && <ScaleStep key={site.scale?.m_per_px} site={site} walls={walls} next={next} saved={saved} />}
        {step === "routes" && <RoutesStep key={site.scale?.m_per_px} site={site} walls={walls} routes={routes} teach={teach} changed={() => void changed()} next={saved} />}
        {step === "vehicle" && <VehicleStep site={site} next={saved} />}
        {step === "locate" && <LocateStep key={walls.revision} site={site} walls={walls} finished={finished} />}
      </div>
      <Watch />
    </main>
  );
}
