import { api } from "../api";
import { noticeText, useText } from "../i18n";
import { usePolled } from "../store";
import { Icon } from "../ui/icon";

function Events() {
  const t = useText();
  const { value } = usePolled(api.events, 2000);
  return (
    <section class="card grow">
      <h2>{t("history.events")}</h2>
      {(value ?? []).length === 0 && <p class="quiet">{t("history.none")}</p>}
      <ol class="events">
        {(value ?? []).map((event, index) => (
          <li key={index} class={event.severity === "info" ? "" : "bad"}>
            <time>{new Date(event.stamp * 1000).toLocaleString()}</time>
            <span>
              {event.severity !== "info" && <Icon name="warning" />} {noticeText(t, "cause", event.what)}
              {event.remedy.text !== "" && <small>{t("history.remedy", { remedy: noticeText(t, "remedy", event.remedy) })}</small>}
            </span>
          </li>
        ))}
      </ol>
    </section>
  );
}

function Statistics() {
  const t = useText();
  const { value } = usePolled(api.statistics, 5000);
  if (!value) return null;
  return (
    <section class="card">
      <h2>{t("history.statistics")}</h2>
      <dl class="gauges">
        <div class="gauge"><dt>{t("history.deliveries")}</dt><dd>{value.deliveries}</dd></div>
      </dl>
    </section>
  );
}

function Recordings() {
  const t = useText();
  const { value } = usePolled(api.recordings, 10_000);
  return (
    <section class="card">
      <h2>{t("history.recordings")}</h2>
      {(value ?? []).length === 0 && <p class="quiet">{t("history.none")}</p>}
      <ul class="files">
        {(value ?? []).map((file) => (
          <li key={file.name}>
            <a class="target" href={`/api/recordings/${encodeURIComponent(file.name)}`} download={file.name}>
              {file.name} <small>{(file.bytes / 1e6).toFixed(1)} MB</small>
            </a>
          </li>
        ))}
      </ul>
    </section>
  );
}

export function HistoryPage() {
  return (
    <main class="page columns">
      <Events />
      <aside>
        <Statistics />
        <Recordings />
      </aside>
    </main>
  );
}
