import { useRef, useState } from "preact/hooks";
import { api } from "../api";
import { useText } from "../i18n";
import { Question } from "./question";
import { attempt, tell } from "./toast";
import { Tool } from "./tool";

/** Restores a backup of a site; over a site that there is only after a word. */
export function Restore({ over, done }: { over: boolean; done: () => void }) {
  const t = useText();
  const input = useRef<HTMLInputElement>(null);
  const [asked, setAsked] = useState<File | null>(null);
  const [working, setWorking] = useState(false);
  const send = async (file: File) => {
    setWorking(true);
    const good = await attempt(() => api.restoreBackup(file));
    setWorking(false);
    if (!good) return;
    tell("restored", t("backup.done", { name: file.name }));
    done();
  };
  const take = (file: File | undefined) => {
    if (file && over) setAsked(file);
    else if (file) void send(file);
  };
  const answer = (yes: boolean) => {
    setAsked(null);
    if (yes && asked) void send(asked);
  };
  return (
    <>
      <input ref={input} type="file" hidden accept=".tar" aria-label={t("backup.restore")}
        onChange={(event) => { take(event.currentTarget.files?.[0]); event.currentTarget.value = ""; }} />
      <Tool icon="undo" label={t(working ? "backup.working" : "backup.restore")} disabled={working} onClick={() => input.current?.click()} />
      {asked && <Question text={t("backup.question", { name: asked.name })} yes={t("backup.restore")} answer={answer} />}
    </>
  );
}
