// Robots: what each can do, and what its readings are.

import { t } from "../lang";
import { get } from "../lib/api";
import { el, replace, type Child } from "../lib/dom";
import { duration, spaced, unitSign } from "../lib/figures";
import { problemNotice } from "../lib/problems";
import type { Page } from "../lib/router";
import type { Robot } from "../lib/types";

interface Profile {
  actions: { name: string; description: string; duration_s: number; measures: string[] }[];
  quantities: { name: string; unit: string }[];
}

export class RobotsPage implements Page {
  private readonly list = el("div", { class: "cards" });
  readonly root = el("main", { class: "page robots" }, el("h2", { class: "page-title" }, t("robots")), this.list);
  private begun = false;

  show(): void {
    if (!this.begun) void this.load();
  }

  private async load(): Promise<void> {
    try {
      const robots = await get<Robot[]>("/robots");
      replace(this.list, ...(await Promise.all(robots.map(card))));
      this.begun = true;
    } catch (problem) {
      replace(this.list, problemNotice(problem));
    }
  }
}

async function card({ name, description }: Robot): Promise<HTMLElement> {
  const { actions, quantities } = await get<Profile>(`/robots/${encodeURIComponent(name)}`);
  const units = new Map(quantities.map((one) => [one.name, one.unit]));
  const measured = (names: string[]): Child => (names.length ? el("span", { class: "hint" }, `${t("measures")} ${names.map((one) => `${spaced(one)} (${unitSign(units.get(one) ?? "")})`).join(", ")}`) : null);
  return el(
    "section",
    { class: "card", "aria-label": name },
    el("h3", {}, name),
    el("p", {}, description),
    el("ul", { class: "actions" }, actions.map((action) => el("li", {}, el("strong", {}, spaced(action.name)), ` · ${duration(action.duration_s)}`, measured(action.measures)))),
  );
}
