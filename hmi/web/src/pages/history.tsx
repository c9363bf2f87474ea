import { useState } from "preact/hooks";
import { api } from "../api";
import type { Event, Session } from "../api_types";
import { dayText, momentText } from "../figures";
import { kindText, noticeText, useText } from "../i18n";
import type { Content } from "../content";
import { usePolled } from "../store";
import { Icon } from "../ui/icon";
import { Restore } from "../ui/restore";
import { Stale } from "../ui/stale";
import { Tabs, type Tab } from "../ui/tabs";
import { Tool } from "../ui/tool";
import { VersionsCard } from "../ui/versions_card";
import { Watch } from "../ui/watch";
import { Changes } from "./changes/changes";

type TabName = "events" | "changes" | "statistics" | "files";

function EventRow({ event }: { event: Event }) {
  const t = useText();
  const bad = event.severity !== "info";
  return (
    <li class={bad ? "bad" : ""}>
      <time dateTime={new Date(event.stamp * 1000).toISOString()}>{momentText(event.stamp)}</time>
      <span>
        {bad && <><Icon name="warning" /><span class="unseen">{t(event.severity === "stop" ? "history.stop" : "history.warning")}</span></>} {noticeText(t, "cause", event.what)}
        {event.remedy.text !== "" && <small>{t("history.remedy", { remedy: noticeText(t, "remedy", event.remedy) })}</small>}
      </span>
    </li>
  );
}

function Events() {
  const t = useText();
  const [only, setOnly] = useState(false);
  const { value, age_s } = usePolled(api.events, 2000);
  const shown = (value ?? []).filter((event) => !only || event.severity !== "info");
  return (
    <section class="grow">
      <div class="buttons">
        <Tool icon="list" label={t("history.all")} pressed={!only} onClick={() => setOnly(false)} />
        <Tool icon="warning" label={t("history.only_stops")} pressed={only} onClick={() => setOnly(true)} />
      </div>
      <Stale age={age_s} limit={5} />
      {shown.length === 0 && <p class="quiet" role="status">{t(value === null ? "history.asking" : "history.none")}</p>}
      <ol class="events">{shown.map((event, index) => <EventRow key={`${event.stamp} ${index}`} event={event} />)}</ol>
    </section>
  );
}

const hours = (seconds: number) => `${Math.floor(seconds / 3600)}:${String(Math.floor(seconds / 60) % 60).padStart(2, "0")}`;

function StatisticsCard() {
  const t = useText();
  const { value, age_s } = usePolled(api.statistics, 3000);
  if (!value) return <p class="quiet" role="status">{t("history.asking")}</p>;
  const stops = value.stops ?? [];
  const most = Math.max(1, ...stops.map((stop) => stop.seconds));
  const figure = (name: string, text: string) => <div class="figure-box"><dt>{name}</dt><dd>{text}</dd></div>;
  return (
    <section class="grow">
      <Stale age={age_s} limit={8} />
      <dl class="figures">
        {figure(t("history.deliveries"), String(value.deliveries))}
        {figure(t("history.distance"), t("unit.km", { value: ((value.distance_m ?? 0) / 1000).toFixed(2) }))}
        {figure(t("history.driving"), t("unit.hours", { value: hours(value.driving_s ?? 0) }))}
        {figure(t("history.standing"), t("unit.hours", { value: hours(value.standing_s ?? 0) }))}
      </dl>
      {value.since !== null && value.since > 0 && <p class="quiet">{t("history.since", { date: dayText(value.since) })}</p>}
      <h2>{t("history.stops")}</h2>
      {stops.length === 0 && <p class="quiet">{t("history.no_stops")}</p>}
      <ul class="bars">
        {stops.map((stop) => (
          <li key={stop.cause.code + stop.cause.text}>
            <span>{kindText(t, stop.cause)}</span>
            <meter min={0} max={most} value={stop.seconds} aria-label={kindText(t, stop.cause)} />
            <span class="quiet">{t("history.times", { count: Math.max(1, stop.count), minutes: (stop.seconds / 60).toFixed(1) })}</span>
          </li>
        ))}
      </ul>
    </section>
  );
}

function Files({ may, restores }: { may: boolean; restores: boolean }) {
  const t = useText();
  const { value, age_s } = usePolled(api.recordings, 5000);
  const link = (href: string, name: string, words: string, size: string) => (
    <li key={href}><a class="target row" href={href} download={name}><Icon name="download" /><span><strong>{words}</strong><small>{size}</small></span></a></li>
  );
  if (!may) return <p class="quiet">{t("history.needs_operator")}</p>;
  return (
    <section class="grow">
      <Stale age={age_s} limit={12} />
      <h2>{t("history.site")}</h2>
      <ul class="files">{link("/api/site/download", "site.tar", t("history.site.download"), t("history.site.what"))}</ul>
      {restores && <div class="buttons"><Restore over done={() => undefined} /></div>}
      <VersionsCard may={restores} />
      <h2>{t("history.recordings")}</h2>
      {(value ?? []).length === 0 && <p class="quiet" role="status">{t(value === null ? "history.asking" : "history.none")}</p>}
      <ul class="files">
        {(value ?? []).map((file) => link(`/api/recordings/${encodeURIComponent(file.name)}`, `${file.name}.tar`, file.name, t("unit.mb", { value: (file.bytes / 1e6).toFixed(1) })))}
      </ul>
    </section>
  );
}

/** Look back: what happened, what changed in the building, how much was done, and files to take away. */
export function HistoryPage({ role, changed, ...content }: Content & { role: Session["role"]; changed: () => Promise<unknown> }) {
  const t = useText();
  const [tab, setTab] = useState<TabName>("events");
  const tabs: Tab<TabName>[] = [
    { name: "events", icon: "list", label: t("history.events") },
    { name: "changes", icon: "box", label: t("history.changes") },
    { name: "statistics", icon: "chart", label: t("history.statistics") },
    { name: "files", icon: "download", label: t("history.files") },
  ];
  return (
    <main class="page history">
      <Tabs label={t("nav.history")} tabs={tabs} shown={tab} choose={setTab}>
        {tab === "events" && <Events />}
        {tab === "changes" && <Changes key={content.site.drawing?.file} {...content} role={role} changed={changed} />}
        {tab === "statistics" && <StatisticsCard />}
        {tab === "files" && <Files may={role === "operator" || role === "integrator"} restores={role === "integrator"} />}
      </Tabs>
      <Watch />
    </main>
  );
}
