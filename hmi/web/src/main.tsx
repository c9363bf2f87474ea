import { render } from "preact";
import { useEffect, useState } from "preact/hooks";
import "ol/ol.css";
import "./styles.css";
import { api, pinWanted } from "./api";
import type { Session, SiteRevisions } from "./api_types";
import { loadContent, newestOnly, type Content } from "./content";
import { language, nextLanguage, textIn, useText } from "./i18n";
import { live } from "./live/live_socket";
import { theme } from "./map/theme";
import { DrivePage } from "./pages/drive";
import { HistoryPage } from "./pages/history";
import { LoginPage } from "./pages/login";
import { SetupPage } from "./pages/setup/setup";
import { CommandBar } from "./ui/command_bar";
import { Icon } from "./ui/icon";
import { Toast, attempt } from "./ui/toast";

type PageName = "drive" | "setup" | "history";
function Rail(props: { page: PageName; role: Session["role"]; needsPin: boolean; go: (page: PageName) => void; leave: () => void }) {
  const t = useText();
  const entry = (name: PageName) => (
    <button type="button" class="target tool" aria-current={props.page === name ? "page" : undefined} onClick={() => props.go(name)}>
      <Icon name={name} />
      <span>{t(`nav.${name}`)}</span>
    </button>
  );
  return (
    <nav class="rail" aria-label={t("app.name")}>
      <h1 class="unseen">{t(`nav.${props.page}`)}</h1>
      {entry("drive")}
      {props.role === "integrator" && entry("setup")}
      {entry("history")}
      <span class="spring" />
      {props.needsPin && <button type="button" class="target tool" onClick={props.leave}><Icon name="bad" /><span>{t("nav.leave")}</span></button>}
      <button type="button" class="target tool" lang={nextLanguage()} onClick={() => language.set(nextLanguage())}>{textIn(nextLanguage(), "language.name")}</button>
      <button type="button" class="target tool" aria-label={t("nav.theme")} onClick={() => theme.set(theme.value === "dark" ? "light" : "dark")}><Icon name="theme" /><span class="theme">{t("nav.theme")}</span></button>
    </nav>
  );
}

/** Calls `load` whenever somebody saved, here, on another panel or from the command line. */
function useRevisions(load: () => Promise<unknown>): void {
  useEffect(() => {
    let known = "";
    return live.newest.watch((frame) => {
      const revisions: SiteRevisions | undefined = frame?.live.revisions;
      if (!revisions) return;
      const next = Object.values(revisions).join();
      if (known !== "" && known !== next) void load();
      known = next;
    });
  }, []);
}

function Panel() {
  const t = useText();
  const [session, setSession] = useState<Session | null>(null);
  const [content, setContent] = useState<Content | null>(null);
  const [page, setPage] = useState<PageName | null>(null);
  const [teach, setTeach] = useState(false);
  const show = (loaded: Content) => {
    const { site, routes } = loaded;
    setContent(loaded);
    setPage((old) => old ?? (site.scale && routes.nodes.length > 0 && site.sensors.length > 0 ? "drive" : "setup"));
  };
  const [newest] = useState(() => newestOnly(() => loadContent(api), show));
  const load = () => attempt(newest);
  const enter = () =>
    void attempt(async () => {
      const current = await api.session();
      setSession(current);
      if (current.role === "none") return live.close();
      live.open();
      await load();
    });
  /** A server that was started anew knows no session: the PIN is asked for where the page stands. */
  const askWho = () =>
    void api.session().then((current) => {
      if (current.role !== "none") return;
      setSession(current);
      live.close();
    }, () => undefined);
  const leave = () => void attempt(api.logout).then(() => { live.close(); setContent(null); enter(); });
  useRevisions(load);
  useEffect(() => {
    enter();
    pinWanted.tell = askWho;
    const unwatch = live.lost.watch(askWho);
    return () => {
      unwatch();
      live.close();
    };
  }, []);
  if (session?.role === "none") return <><LoginPage entered={enter} /><CommandBar role="none" /><Toast /></>;
  if (!session || !content || !page) return <><main class="page starting">{t("app.name")}</main><CommandBar role={session?.role ?? "none"} /><Toast /></>;
  const { role } = session;
  const shown = role === "integrator" || page !== "setup" ? page : "drive";
  const version = content.site.walls_revision + content.site.routes_revision;
  return (
    <>
      <Rail page={shown} role={role} needsPin={session.needs_pin} go={(next) => { setTeach(false); setPage(next); }} leave={leave} />
      {shown === "drive" && <DrivePage key={version} {...content} role={role} changed={load} teach={() => { setTeach(true); setPage("setup"); }} />}
      {shown === "setup" && <SetupPage {...content} teach={teach} changed={load} finished={() => setPage("drive")} />}
      {shown === "history" && <HistoryPage {...content} role={role} changed={load} />}
      <CommandBar role={role} />
      <Toast />
    </>
  );
}

const root = document.getElementById("panel");
if (root) {
  root.textContent = "";  // the name that is shown while the page loads
  render(<Panel />, root);
}
