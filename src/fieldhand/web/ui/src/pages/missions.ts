// Missions: those that the server carries out, and one of them as it happens.

import { current, statusWords, t } from "../lang";
import { get, Problem } from "../lib/api";
import { el, replace } from "../lib/dom";
import { metres, number } from "../lib/figures";
import { problemNotice } from "../lib/problems";
import type { Page } from "../lib/router";
import { stream } from "../lib/stream";
import type { MissionState } from "../lib/types";
import { MissionView } from "./mission";
import { localTime } from "./results";

let offered: Promise<boolean> | null = null;

// Whether the server carries out missions.
export function missionsOffered(): Promise<boolean> {
  offered ??= get("/missions?limit=1").then(
    () => true,
    (problem) => {
      if (problem instanceof Problem && problem.status !== 404) offered = null; // asked again next time
      return false;
    },
  );
  return offered;
}

export const stateWords = ({ state, status }: MissionState): string => (state === "ended" ? statusWords(status) : t(`state_${state}`));

export class MissionsPage implements Page {
  readonly root = el("div", {});
  private readonly list = el("ul", { class: "list" });
  private readonly overview = el("main", { class: "page missions" }, el("section", { class: "card", "aria-labelledby": "missions-title" }, el("h2", { id: "missions-title" }, t("missions")), this.list));
  private readonly states = new Map<string, MissionState>();
  private view: MissionView | null = null;
  private stop: (() => void) | null = null;

  show(id: string): void {
    this.leave();
    if (id) {
      this.view = new MissionView(id);
      replace(this.root, this.view.root);
      this.view.open();
      return;
    }
    replace(this.root, this.overview);
    this.stop = stream.listen((heard) => {
      if (heard.kind !== "mission") return;
      this.states.set(heard.data.id, heard.data);
      this.draw();
    });
    stream.follow("all");
    void this.load();
  }

  hide(): void {
    this.leave();
    stream.follow([]);
  }

  private leave(): void {
    this.view?.close();
    this.stop?.();
    this.view = this.stop = null;
  }

  private async load(): Promise<void> {
    try {
      const listed = await get<MissionState[]>(`/missions?lang=${current()}`);
      this.states.clear();
      for (const state of listed) this.states.set(state.id, state);
      this.draw();
    } catch (problem) {
      replace(this.list, el("li", {}, problemNotice(problem)));
    }
  }

  private draw(): void {
    const states = [...this.states.values()].sort((a, b) => b.begun_at.localeCompare(a.begun_at));
    if (!states.length) return replace(this.list, el("li", { class: "hint" }, t("no_missions")));
    replace(this.list, ...states.map(entry));
  }
}

function entry(state: MissionState): HTMLElement {
  const facts = [state.site, state.robot, state.by, localTime(state.begun_at)];
  const way = state.travelled_m === null ? "" : `${metres(state.travelled_m)}, ${number(state.charge_percent ?? 0)} %`;
  return el(
    "li",
    {},
    el(
      "a",
      { class: "row", href: `#/missions/${encodeURIComponent(state.id)}` },
      el("span", { class: "line" }, el("strong", { class: "grow" }, state.request), el("span", { class: `chip ${state.state} ${state.status}` }, stateWords(state))),
      el("span", { class: "hint" }, [...facts, way].filter(Boolean).join(" · ")),
    ),
  );
}
