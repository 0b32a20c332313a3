// The page: navigation, language, connection, and one page of the router at a time.

import { current, LANGUAGES, t } from "./lang";
import { connection } from "./lib/connection";
import { el, icon, replace } from "./lib/dom";
import { remember } from "./lib/kept";
import { Router } from "./lib/router";
import { session } from "./lib/session";
import { AskPage } from "./pages/ask";
import { loginPage } from "./pages/login";
import { RobotsPage } from "./pages/robots";
import { SitesPage } from "./pages/sites";
import "./style.css";

const LINKS = [
  { name: "ask", words: t("nav_ask"), drawn: ["M4 5h16v11H9l-5 4z"] },
  { name: "sites", words: t("nav_sites"), drawn: ["M3 6l6-2 6 2 6-2v14l-6 2-6-2-6 2z", "M9 4v14M15 6v14"] },
  { name: "robots", words: t("nav_robots"), drawn: ["M5 9h14v9H5z", "M12 9V5M9 13h.01M15 13h.01"] },
];

function header(): HTMLElement {
  const languages = el("select", { "aria-label": t("language"), class: "language" }, LANGUAGES.map(([code, name]) => el("option", { value: code, lang: code, selected: code === current() }, name)));
  languages.addEventListener("change", () => {
    remember("language", languages.value);
    location.reload();
  });
  const leave = el("button", { type: "button", class: "leave", onclick: () => void session.leave().then(() => location.reload()) }, t("log_out"));
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

function skip(event: Event): void {
  event.preventDefault();
  document.querySelector<HTMLElement>("#content textarea, #content button, #content a")?.focus();
}

function navigation(): { root: HTMLElement; mark(name: string): void } {
  const links = LINKS.map(({ name, words, drawn }) => ({ name, link: el("a", { href: `#/${name}` }, icon(...drawn), el("span", {}, words)) }));
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
  document.documentElement.lang = current();
  await session.begin();
  const banner = connectionBanner();
  if (session.state === "out") {
    document.body.append(header(), banner, loginPage(() => location.reload()));
  } else {
    const tabs = navigation();
    const router = new Router(
      [
        { name: "ask", make: () => new AskPage() },
        { name: "sites", make: () => new SitesPage() },
        { name: "robots", make: () => new RobotsPage() },
      ],
      "ask",
    );
    router.onchange = (name) => tabs.mark(name);
    document.body.append(header(), tabs.root, banner, router.outlet);
    router.begin();
  }
  connection.begin();
  // Where the address is not trusted (plain HTTP from another device) the browser offers no worker.
  if ("serviceWorker" in navigator) await navigator.serviceWorker.register("/sw.js").catch(() => undefined);
}

void begin();
