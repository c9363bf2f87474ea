import { render } from "preact";
import { useEffect, useState } from "preact/hooks";
import "ol/ol.css";
import "./styles.css";
import { api } from "./api";
import type { Routes, Session, Site, Walls } from "./api_types";
import { language, useText } from "./i18n";
import { live } from "./live/live_socket";
import { DrivePage } from "./pages/drive";
import { HistoryPage } from "./pages/history";
import { LoginPage } from "./pages/login";
import { SetupPage } from "./pages/setup/setup";
import { CommandBar } from "./ui/command_bar";
import { Icon } from "./ui/icon";
import { Toast, attempt } from "./ui/toast";

type PageName = "drive" | "setup" | "history";
interface Content {
  site: Site;
  walls: Walls;
  routes: Routes;
}

const theme = localStorage.getItem("madori.theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
document.documentElement.dataset.theme = theme;

function switchTheme(): void {
  const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
  document.documentElement.dataset.theme = next;
  localStorage.setItem("madori.theme", next);
}

function Rail(props: { page: PageName; role: Session["role"]; go: (page: PageName) => void }) {
  const t = useText();
  const entry = (name: PageName) => (
    <button class="target" aria-current={props.page === name ? "page" : undefined} onClick={() => props.go(name)}>
      <Icon name={name} />
      <span>{t(`nav.${name}`)}</span>
    </button>
  );
  return (
    <nav class="rail" aria-label={t("app.name")}>
      {entry("drive")}
      {props.role === "integrator" && entry("setup")}
      {entry("history")}
      <span class="spring" />
      <button class="target" onClick={() => language.set(language.value === "en" ? "ja" : "en")}>{t("nav.language")}</button>
      <button class="target" aria-label={t("nav.theme")} onClick={switchTheme}><Icon name="theme" /></button>
    </nav>
  );
}

function Panel() {
  const [session, setSession] = useState<Session | null>(null);
  const [content, setContent] = useState<Content | null>(null);
  const [page, setPage] = useState<PageName | null>(null);
  const load = () =>
    void attempt(async () => {
      const [site, walls, routes] = await Promise.all([api.site(), api.walls(), api.routes()]);
      setContent({ site, walls, routes });
      setPage((old) => old ?? (site.scale && routes.nodes.length > 0 ? "drive" : "setup"));
    });
  const enter = () =>
    void attempt(async () => {
      const current = await api.session();
      setSession(current);
      if (current.role === "none") return;
      live.open();
      load();
    });
  useEffect(() => {
    enter();
    return () => live.close();
  }, []);
  if (session?.role === "none") return <LoginPage entered={enter} />;
  if (!session || !content || !page) return <Toast />;
  const shown = session.role === "integrator" || page !== "setup" ? page : "drive";
  const version = content.site.walls_revision + content.site.routes_revision;
  return (
    <>
      <Rail page={shown} role={session.role} go={setPage} />
      {shown === "drive" && <DrivePage key={version} {...content} />}
      {shown === "setup" && <SetupPage {...content} changed={load} />}
      {shown === "history" && <HistoryPage />}
      <CommandBar />
      <Toast />
    </>
  );
}

const root = document.getElementById("panel");
if (root) render(<Panel />, root);
