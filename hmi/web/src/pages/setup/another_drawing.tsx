import { useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { Job, RevisionPreview } from "../../api_types";
import { useText } from "../../i18n";
import { Question } from "../../ui/question";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";
import { JobCard } from "./job_card";
import { kDrawingTypes } from "./upload";

/** A new drawing, with what it would change. */
export interface Revised {
  file: File;
  preview: RevisionPreview;
}

/**
 * Another drawing for a site that has one: it is laid on the old one and looked at first. One that does not lie on it
 * takes its place only after a word.
 */
export function AnotherDrawing({ revised, replace }: { revised: (revised: Revised) => void; replace: (file: File) => void }) {
  const t = useText();
  const input = useRef<HTMLInputElement>(null);
  const [file, setFile] = useState<File | null>(null);
  const [asks, setAsks] = useState(false);
  const look = (chosen: File | undefined) => {
    if (chosen) void attempt(() => api.previewDrawing(chosen)).then((good) => good && setFile(chosen));
  };
  const done = () => {
    if (file) void attempt(async () => revised({ file, preview: await api.preview() })).then((good) => !good && setFile(null));
  };
  const failed = (job: Job) => {
    const another = job.error.values["kind"] === "no-revision";
    setAsks(another);
    if (!another) setFile(null);
    return another;
  };
  const answer = (yes: boolean) => {
    setAsks(false);
    setFile(null);
    if (yes && file) replace(file);
  };
  if (file && !asks) return <JobCard kind="preview" done={done} failed={failed} />;
  return (
    <div class="here">
      <input ref={input} type="file" hidden accept={kDrawingTypes} aria-label={t("drawing.replace")}
        onChange={(event) => { look(event.currentTarget.files?.[0]); event.currentTarget.value = ""; }} />
      <Tool icon="file" label={t("drawing.replace")} onClick={() => input.current?.click()} />
      {asks && file && <Question text={`${t("error.no-revision", { name: file.name })} ${t("drawing.question", { name: file.name })}`} yes={t("drawing.replace.yes")} answer={answer} />}
    </div>
  );
}
