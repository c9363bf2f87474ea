import { useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { Job } from "../../api_types";
import { useText } from "../../i18n";
import { Question } from "../../ui/question";
import { Tool } from "../../ui/tool";
import { attempt } from "../../ui/toast";
import { JobCard } from "./job_card";

const kTypes = ".dxf,.pdf,.png,.jpg,.jpeg,.tif,.tiff,.bmp,.svg";

/** Takes a drawing file, by a tap or by dropping it, and follows its import. */
export function Upload({ done, first }: { done: (job: Job) => void; first: boolean }) {
  const t = useText();
  const [working, setWorking] = useState(false);
  const [over, setOver] = useState(false);
  const input = useRef<HTMLInputElement>(null);
  const [asked, setAsked] = useState<File | null>(null);
  const send = (file: File) => {
    void attempt(() => api.uploadDrawing(file, {})).then(setWorking);
  };
  /** Another drawing takes the place of drawing, scale and walls: only after a word. */
  const take = (file: File | undefined) => {
    if (file && first) send(file);
    else if (file) setAsked(file);
  };
  if (working) return <JobCard kind="import" done={done} ended={() => setWorking(false)} />;
  const chooser = (
    <>
      <input ref={input} type="file" hidden accept={kTypes} aria-label={t("drawing.choose")}
        onChange={(event) => { take(event.currentTarget.files?.[0]); event.currentTarget.value = ""; }} />
      <Tool icon="file" label={first ? t("drawing.choose") : t("drawing.replace")} primary={first} onClick={() => input.current?.click()} />
    </>
  );
  const answer = (yes: boolean) => {
    setAsked(null);
    if (yes && asked) send(asked);
  };
  if (!first) return <div class="here">{chooser}{asked && <Question text={t("drawing.question", { name: asked.name })} yes={t("drawing.replace.yes")} answer={answer} />}</div>;
  return (
    <section class={over ? "card drop over" : "card drop"}
      onDragOver={(event) => { event.preventDefault(); setOver(true); }} onDragLeave={() => setOver(false)}
      onDrop={(event) => { event.preventDefault(); setOver(false); take(event.dataTransfer?.files[0]); }}>
      <p>{t("drawing.hint")}</p>
      <div class="buttons">{chooser}</div>
    </section>
  );
}
