import { useState } from "preact/hooks";
import type { Routes, Site, Walls } from "../../api_types";
import { useText } from "../../i18n";
import type { TextKey } from "../../i18n/en";
import { DrawingStep } from "./drawing_step";
import { RoutesStep } from "./routes_step";
import { ScaleStep } from "./scale_step";
import { VehicleStep } from "./vehicle_step";

const steps = ["drawing", "scale", "routes", "vehicle"] as const;
type Step = (typeof steps)[number];

/** Where a person who comes back goes on. */
function firstOpen(site: Site, routes: Routes): Step {
  if (!site.drawing) return "drawing";
  if (!site.scale) return "scale";
  return routes.nodes.length === 0 ? "routes" : "vehicle";
}

export function SetupPage(props: { site: Site; walls: Walls; routes: Routes; changed: () => void }) {
  const t = useText();
  const { site, walls, routes, changed } = props;
  const [step, setStep] = useState<Step>(firstOpen(site, routes));
  const open = (name: Step) => name === "drawing" || (site.drawing !== null && (name === "scale" || site.scale !== null));
  return (
    <main class="page">
      <nav class="steps" aria-label={t("nav.setup")}>
        {steps.map((name, i) => (
          <button key={name} class="target" aria-current={name === step ? "step" : undefined} disabled={!open(name)} onClick={() => setStep(name)}>
            <b>{i + 1}</b> {t(`setup.${name}` as TextKey)}
          </button>
        ))}
      </nav>
      <div class="with-map step" key={step}>
        {step === "drawing" && <DrawingStep site={site} walls={walls} changed={changed} />}
        {step === "scale" && <ScaleStep key={site.scale?.m_per_px} site={site} walls={walls} changed={changed} />}
        {step === "routes" && <RoutesStep site={site} walls={walls} routes={routes} changed={changed} />}
        {step === "vehicle" && <VehicleStep site={site} />}
      </div>
    </main>
  );
}
