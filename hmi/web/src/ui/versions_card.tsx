import { useState } from "preact/hooks";
import { api } from "../api";
import type { SiteVersion, VersionDiff } from "../api_types";
import { momentText } from "../figures";
import { useText } from "../i18n";
import { usePolled } from "../store";
import { Question } from "./question";
import { savedText } from "./saved_text";
import { Stale } from "./stale";
import { attempt } from "./toast";
import { Tool } from "./tool";

function Difference({ diff }: { diff: VersionDiff }) {
  const t = useText();
  const length = (pieces: readonly number[][]) => pieces.reduce((sum, [x1 = 0, y1 = 0, x2 = 0, y2 = 0]) => sum + Math.hypot(x2 - x1, y2 - y1), 0).toFixed(1);
  return (
    <p role="status">
      {diff.drawing_changed && `${t("versions.drawing")} `}
      {t("versions.walls", { gone: length(diff.gone), added: length(diff.added) })} {t("versions.points", { count: diff.points_changed.length })}
    </p>
  );
}

/** Every save of the site, newest first: compared with what is now, and brought back. */
export function VersionsCard({ may }: { may: boolean }) {
  const t = useText();
  const { value, age_s, refresh } = usePolled(api.versions, 5000);
  const [chosen, setChosen] = useState<SiteVersion | null>(null);
  const [diff, setDiff] = useState<VersionDiff | null>(null);
  const [asks, setAsks] = useState(false);
  const newest = value?.at(-1);
  const choose = (version: SiteVersion) => {
    setChosen(version);
    setDiff(null);
    if (newest) void attempt(async () => setDiff(await api.compareVersions(version.number, newest.number)));
  };
  const restore = () => chosen && void attempt(() => api.restoreVersion(chosen.number)).then(refresh);
  return (
    <section class="versions">
      <h2>{t("versions.title")}</h2>
      <Stale age={age_s} limit={12} />
      {value?.length === 0 && <p class="quiet">{t("versions.none")}</p>}
      <ul class="files">
        {[...(value ?? [])].reverse().slice(0, 50).map((version) => (
          <li key={version.number}>
            <button type="button" class="target row" aria-pressed={chosen?.number === version.number} onClick={() => choose(version)}>
              <b>{version.number}</b><span><strong>{savedText(t, version.sentence)}</strong><small>{momentText(version.stamp)} · {savedText(t, version.author)}</small></span>
            </button>
            {chosen?.number === version.number && diff && <Difference diff={diff} />}
            {chosen?.number === version.number && may && version.number !== newest?.number && <div class="buttons"><Tool icon="undo" label={t("versions.restore")} onClick={() => setAsks(true)} /></div>}
          </li>
        ))}
      </ul>
      {asks && chosen && <Question text={t("versions.question", { number: chosen.number })} yes={t("versions.restore")} answer={(yes) => { setAsks(false); if (yes) restore(); }} />}
    </section>
  );
}
