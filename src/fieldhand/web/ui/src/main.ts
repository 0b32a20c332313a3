// The page: navigation, language, connection, and one page of the router at a time.

import { current, LANGUAGES, t } from "./lang";
import { access } from "./lib/api";
import { connection } from "./lib/connection";
import { el, icon, replace } from "./lib/dom";
import { forget, remember } from "./lib/kept";
import { Router } from "./lib/router";
import { session } from "./lib/session";
import { AskPage } from "./pages/ask";
import { loginPage } from "./pages/login";
import { MissionsPage, missionsOffered } from "./pages/missions";
import { RobotsPage } from "./pages/robots";
import { SitesPage } from "./pages/sites";
import "./style.css";

const MISSIONS = { name: "missions", words: t("nav_missions"), drawn: ["M12 21s-7-6.5-7-12a7 7 0 0 1 14 0c0 5.500-7 12-7 12z", "M12 9h.01"] };
const LINKS = [
  { name: "ask", words: t("nav_ask"), drawn: ["M4 5h16v11H9l-5 4z"] },
  { name: "sites", words: t("nav_sites"), drawn: ["M3 6l6-2 6 2 6-2v14l-6 2-6-2-6 2z", "M9 4v14M15 6v14"] },
  { name: "robots", words: t("nav_robots"), drawn: ["M5 9h14v9H5z", "M12 9V5M9 13h.01M15 13h.01"] },
];

function header(): HTMLElement {
  const languages = el("select", { "aria-label": t("language"), class: "language" }, LANGUAGES.map(([code, name]) => el("option", { value: code, lang: code, selected: code === current() }, name)));
  languages.addEventListener("change", () => {
    remember("language", languages.value);
    void session.speak(languages.value).then(() => location.reload());
  });
  const leaving = `${t("log_out")} (${session.name})`;
  const leave = el("button", { type: "button", class: "leave", "aria-label": leaving, title: leaving, onclick: logOut }, icon("M10 4H5v16h5M14 8l4 4-4 4M18 12H9"));
  return el(
    "header",
    { class: "top" },
    el("a", { class: "skip", href: "#content", onclick: skip }, t("skip")),
    el("img", { src: "/static/icon.svg", alt: "", width: 32, height: 32 }),
    el("h1", {}, "Fieldhand"),
    el("div", { class: "grow" }),
    session.state === "in" ? el("span", { class: "who" }, session.name) : null,
    languages,
    session.state === "in" ? leave : null,
  );
}

// What was asked belongs to who asked it: it does not stay on the device for the next one.
async function logOut(): Promise<void> {
  await session.leave();
  remember("request", "");
  await forget("ask.last");
  location.reload();
}

function skip(event: Event): void {
  event.preventDefault();
  document.querySelector<HTMLElement>("#content textarea, #content button, #content a")?.focus();
}

function navigation(missions: boolean): { root: HTMLElement; mark(name: string): void } {
  const [first, ...rest] = LINKS;
  const links = [first!, ...(missions ? [MISSIONS] : []), ...rest].map(({ name, words, drawn }) => ({ name, link: el("a", { href: `#/${name}` }, icon(...drawn), el("span", {}, words)) }));
  return {
    root: el("nav", { class: "tabs", "aria-label": t("pages") }, links.map(({ link }) => link)),
    mark(name) {
      for (const one of links) {
        if (one.name === name) one.link.setAttribute("aria-current", "page");
        else one.link.removeAttribute("aria-current");
      }
    },
  };
}

// Says that what is shown may be old, and since when.
function connectionBanner(): HTMLElement {
  const banner = el("div", { class: "banner", role: "status" });
  connection.watch((connected) => {
    const since = new Intl.DateTimeFormat(current(), { timeStyle: "medium" }).format(new Date());
    replace(banner, connected ? null : el("p", {}, t("no_connection", { time: since })));
    document.documentElement.classList.toggle("offline", !connected);
  });
  return banner;
}

async function begin(): Promise<void> {
  await session.begin();
  document.documentElement.lang = current();
  access.onend = () => location.reload();
  let offered = false;
  const banner = connectionBanner();
  if (session.state === "out") {
    document.body.append(header(), banner, loginPage(() => location.reload()));
  } else {
    offered = await missionsOffered();
    const tabs = navigation(offered);
    const router = new Router(
      [
        { name: "ask", make: () => new AskPage() },
        ...(offered ? [{ name: "missions", make: () => new MissionsPage() }] : []),
        { name: "sites", make: () => new SitesPage() },
        { name: "robots", make: () => new RobotsPage() },
      ],
      "ask",
    );
    router.onchange = (name) => tabs.mark(name);
    const licences = el("footer", {}, el("a", { class: "back", href: "/static/third-party.txt" }, t("licences")));
    document.body.append(header(), tabs.root, banner, router.outlet, licences);
    router.begin();
  }
  // What was opened without the server does not know yet who this is, and what the server offers.
  const begun = session.state;
  connection.watch((connected) => void (connected && begun === "unknown" && location.reload()));
  connection.begin(offered);
  // Where the address is not trusted (plain HTTP from another device) the browser offers no worker.
  if ("serviceWorker" in navigator) await navigator.serviceWorker.register("/sw.js").catch(() => undefined);
}

void begin();
