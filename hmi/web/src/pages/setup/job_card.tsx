import { useEffect, useState } from "preact/hooks";
import { api } from "../../api";
import type { Job } from "../../api_types";
import { useText } from "../../i18n";
import { en, type TextKey } from "../../i18n/en";
import { attempt, tell } from "../../ui/toast";
import { Tool } from "../../ui/tool";

const kAsk_ms = 250;

interface Props {
  kind: string;
  done: (job: Job) => void;
  /** true where it says itself what went wrong */
  failed?: (job: Job) => boolean;
  ended?: () => void;
}

/** Follows the server's long work: shows how far it is until it ends, then calls `done`. */
export function JobCard({ kind, done, failed, ended }: Props) {
  const t = useText();
  const [job, setJob] = useState<Job | null>(null);
  useEffect(() => {
    let open = true;
    const ask = async () => {
      try {
        const state = await api.job();
        if (!open) return;
        setJob(state);
        if (state.running) return void setTimeout(() => void ask(), kAsk_ms);
        if (state.error.text === "") done(state);
        else if (!failed?.(state)) tell(state.error.values["kind"] ?? state.error.code, state.error.text, state.error.values);
        ended?.();
      } catch {
        if (open) setTimeout(() => void ask(), 1000);
      }
    };
    void ask();
    return () => {
      open = false;
    };
  }, []);
  const stage = `stage.${job?.stage ?? ""}`;
  const words = stage in en ? t(stage as TextKey) : kind === "tiles" ? (job?.stage ?? "") : t("drawing.stage");
  return (
    <section class="card" aria-live="polite">
      <p>{t(kind === "tiles" ? "scale.photo.working" : "drawing.working", { stage: words })}</p>
      <progress value={job?.share ?? 0} max={1} aria-label={words === "" ? t("drawing.stage") : words} />
      <div class="buttons"><Tool icon="bad" label={t("drawing.stop")} onClick={() => void attempt(() => api.cancelJob())} /></div>
    </section>
  );
}
