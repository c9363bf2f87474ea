import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import type { ScaleResult, Site, Walls } from "../../api_types";
import { uncertainty } from "../../figures";
import { useText } from "../../i18n";
import { Tool } from "../../ui/tool";
import { KnownScale } from "./known_scale";
import { OverlayScale } from "./overlay_scale";
import { PairScale } from "./pair_scale";

/** What every way to a scale is given. */
export interface ScaleWay {
  site: Site;
  walls: Walls;
  /** the choice between the ways */
  ways: ComponentChildren;
  /** the buttons that apply a result and go on */
  finish: (result: ScaleResult | null, apply: (force?: boolean) => Promise<boolean>) => ComponentChildren;
}

type Way = "known" | "pairs" | "overlay";

/** Step 2: the drawing gets its true scale, by known lengths, by points on an aerial photograph, or laid over it by eye. */
export function ScaleStep({ site, walls, saved, next }: { site: Site; walls: Walls; saved: () => void; next: () => void }) {
  const t = useText();
  const [way, setWay] = useState<Way>("known");
  const sure = uncertainty(site.scale?.relative_uncertainty ?? 0);
  const ways = (
    <>
      <p class="facts">{site.scale ? t(sure === "" ? "scale.now.unsure" : "scale.now", { scale: (1000 * site.scale.m_per_px).toFixed(3), percent: sure }) : t("scale.none")}</p>
      <div class="buttons" role="group" aria-label={t("scale.ways")}>
        <Tool icon="ruler" label={t("scale.length")} pressed={way === "known"} onClick={() => setWay("known")} />
        <Tool icon="pin" label={t("scale.pairs")} pressed={way === "pairs"} onClick={() => setWay("pairs")} />
        <Tool icon="photo" label={t("scale.overlay")} pressed={way === "overlay"} onClick={() => setWay("overlay")} />
      </div>
    </>
  );
  const take = (apply: () => Promise<boolean>) => void apply().then((good) => good && saved());
  const finish = (result: ScaleResult | null, apply: (force?: boolean) => Promise<boolean>) => (
    <div class="buttons finish">
      <Tool icon="good" label={t("scale.apply")} primary={result !== null && result.verdict !== "refused"} disabled={result === null || result.verdict === "refused"}
        onClick={() => take(apply)} />
      {way === "overlay" && result?.verdict === "refused" && <Tool icon="warning" label={t("scale.force")} onClick={() => take(() => apply(true))} />}
      <Tool icon="next" label={t("setup.next")} primary={site.scale !== null && result === null} disabled={site.scale === null} onClick={next} />
    </div>
  );
  const given: ScaleWay = { site, walls, ways, finish };
  if (way === "known") return <KnownScale {...given} />;
  return way === "pairs" ? <PairScale {...given} /> : <OverlayScale {...given} />;
}
