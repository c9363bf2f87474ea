import { useRef } from "preact/hooks";
import { api } from "../../api";
import { useText } from "../../i18n";
import { Icon } from "../../ui/icon";
import { attempt, tell } from "../../ui/toast";
import { Tool } from "../../ui/tool";

/** The two published files, in and out, byte for byte. */
export function CsvCard({ imported, saved }: { imported: () => void; saved: boolean }) {
  const t = useText();
  const input = useRef<HTMLInputElement>(null);
  const take = async (files: FileList | null) => {
    const named = (part: string) => [...(files ?? [])].find((file) => file.name.includes(part));
    const tree = named("tree");
    const path = named("path");
    if (!tree || !path) return tell("both-files", "choose tree.csv and path.csv together");
    const csv = { revision: "", tree: await tree.text(), path: await path.text() };
    if (await attempt(() => api.importRoutes(csv))) imported();
  };
  const file = (name: string) => (
    <a class="target tool" href={`/api/site/routes/${name}`} download={name}><Icon name="download" /><span>{name}</span></a>
  );
  return (
    <section class="csv">
      <input ref={input} type="file" hidden multiple accept=".csv" aria-label={t("routes.import")} onChange={(event) => { void take(event.currentTarget.files); event.currentTarget.value = ""; }} />
      <div class="buttons">
        <Tool icon="file" label={t("routes.import")} onClick={() => input.current?.click()} />
        {saved && file("tree.csv")}
        {saved && file("path.csv")}
      </div>
    </section>
  );
}
