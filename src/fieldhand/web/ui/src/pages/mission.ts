// One live mission: where the robot is, what it does, commands to it, and what came of it.

import { current, t } from "../lang";
import { get, post } from "../lib/api";
import { connection } from "../lib/connection";
import { el, notice, replace, sentence } from "../lib/dom";
import { clock, metres, number } from "../lib/figures";
import { problemNotice } from "../lib/problems";
import { Recording, until } from "../lib/recording";
import { session } from "../lib/session";
import { stream } from "../lib/stream";
import type { Heard, Mission, MissionEvent, MissionState, Position, RobotPosition, Run } from "../lib/types";
import { FieldMap } from "../map/field_map";
import { planText } from "./answer";
import { legend } from "./legend";
import { stateWords } from "./missions";
import { Replay } from "./replay";
import { captureOf, localTime } from "./results";

const STALE_MS = 3000;
const SURE_MS = 5000; // within which a second touch means it
const FILES = ["observations.csv", "results.geojson", "log"] as const;

type Command = "pause" | "resume" | "return" | "abort";

interface Confirmation {
  confirmed: boolean;
  sent: boolean;
  why: string;
}

export class MissionView {
  readonly root: HTMLElement;
  private readonly map = new FieldMap(t("map"));
  private readonly title = el("h2", { id: "mission-title" });
  private readonly chip = el("span", { class: "chip" });
  private readonly head = el("div", {});
  private readonly facts = el("dl", { class: "facts" });
  private readonly age = el("p", { class: "hint", role: "status" });
  private readonly buttons = el("div", { class: "buttons" });
  private readonly told = el("div", { role: "alert" });
  private readonly events = el("ol", { class: "events", tabindex: 0, "aria-label": t("events") });
  private readonly eventsBox = el("details", { class: "more", open: true }, el("summary", {}, t("events")), this.events);
  private readonly results = el("div", { class: "results" });
  private readonly plan = el("div", {});
  private recording = new Recording();
  private mission: Mission | null = null;
  private state: MissionState | null = null;
  private position: RobotPosition | null = null;
  private seenAt = 0; // when the position came
  private replay: Replay | null = null;
  private stop: (() => void) | null = null;
  private timer = 0;
  private last = 0; // number of the last event

  constructor(private readonly id: string) {
    this.root = el(
      "main",
      { class: "page mission" },
      el("section", { class: "card", "aria-labelledby": "mission-title" }, el("p", {}, el("a", { href: "#/missions", class: "back" }, `‹ ${t("missions")}`)), el("div", { class: "line" }, this.title, el("span", { class: "grow" }), this.chip), this.head, this.facts, this.age, this.buttons, this.told),
      el("section", { class: "card map", "aria-label": t("map") }, this.map.root, legend()),
      this.results,
      el("section", { class: "card", "aria-label": t("events") }, this.eventsBox),
      el("section", { class: "card", "aria-label": t("the_plan") }, el("h2", {}, t("the_plan")), this.plan),
    );
    for (const command of ["pause", "resume", "return", "abort"] as const) this.buttons.append(this.button(command));
    this.buttons.hidden = true;
  }

  open(): void {
    document.documentElement.classList.add("answered");
    void this.load();
  }

  close(): void {
    document.documentElement.classList.remove("answered");
    this.stop?.();
    clearInterval(this.timer);
    this.replay?.pause();
  }

  private async load(): Promise<void> {
    try {
      this.mission = await get<Mission>(`/missions/${encodeURIComponent(this.id)}?lang=${current()}`);
    } catch (problem) {
      return replace(this.told, problemNotice(problem));
    }
    this.map.showSite(this.mission.map.features);
    this.map.showPlan(this.mission.map.features);
    replace(this.plan, planText(this.mission, this.map));
    this.title.textContent = this.mission.request;
    replace(this.head, el("p", { class: "hint" }, [this.mission.site, this.mission.robot, t("approved_by_at", { name: this.mission.by, time: localTime(this.mission.begun_at) })].join(" · ")));
    this.take(this.mission);
    this.stop = stream.listen((heard) => this.hear(heard));
    stream.follow([this.id]);
    this.timer = window.setInterval(() => this.watchAge(), 500);
  }

  private hear(heard: Heard): void {
    if (heard.kind === "heartbeat" || (heard.kind === "mission" ? heard.data.id : heard.data.mission) !== this.id) return;
    if (heard.kind === "mission") this.take(heard.data);
    if (heard.kind === "event") this.note(heard.data);
    if (heard.kind === "position") {
      this.position = heard.data;
      this.seenAt = performance.now();
      this.draw();
    }
    if (heard.kind === "gone") replace(this.told, notice("warning", t("mission_gone", { why: heard.data.why })));
  }

  private take(state: MissionState): void {
    const ended = state.state === "ended" && this.state?.state !== "ended";
    this.state = state;
    this.chip.textContent = stateWords(state);
    this.chip.className = `chip ${state.state} ${state.status}`;
    const fact = (name: string, value: string) => (value ? el("div", {}, el("dt", {}, name), el("dd", {}, value)) : null);
    replace(
      this.facts,
      state.state === "ended" ? null : fact(t("doing"), [state.doing, state.doing.includes(state.near) ? "" : state.near].filter(Boolean).join(", ")),
      fact(t("time"), state.seconds === null ? "" : clock(state.seconds)),
      fact(t("driven"), state.travelled_m === null ? "" : metres(state.travelled_m)),
      fact(t("battery"), state.charge_percent === null ? "" : `${number(state.charge_percent)} %`),
      fact(t("captures"), String(state.captures)),
    );
    if (state.fault) replace(this.told, notice("error", sentence(state.fault)));
    this.buttons.hidden = state.state === "ended" || !session.may("command");
    for (const button of this.buttons.querySelectorAll<HTMLButtonElement>("button")) {
      const { command } = button.dataset;
      button.hidden = (command === "pause" && state.state !== "running") || (command === "resume" && state.state !== "paused" && state.state !== "interrupted");
    }
    for (const step of this.plan.querySelectorAll<HTMLElement>("[data-nodes]")) {
      step.classList.toggle("lit", state.state !== "ended" && (step.dataset["nodes"] ?? "").split(" ").includes(state.node));
    }
    if (ended || state.state === "ended") this.finish();
    else this.draw();
  }

  private note({ n, event, told }: MissionEvent): void {
    if (n <= this.last) return; // sent again
    this.last = n;
    this.recording.add(event, told);
    if (told) {
      const low = this.events.scrollTop + this.events.clientHeight > this.events.scrollHeight - 40;
      this.events.append(el("li", {}, told.trim()));
      if (low) this.events.scrollTop = this.events.scrollHeight;
    }
    if (event.event === "mission") this.finish();
    else this.draw();
  }

  // Track, captures and robot as far as they are known.
  private draw(): void {
    const projection = this.map.projection;
    if (!projection || !this.state || this.replay) return;
    const track: Position[] = [];
    for (const { geometry, properties } of this.recording.features) if (properties.role === "leg" && geometry.type === "LineString") track.push(...geometry.coordinates);
    const at: Position | null = this.position ? [this.position.lon, this.position.lat] : this.state.lon === null || this.state.lat === null ? null : [this.state.lon, this.state.lat];
    const path = this.recording.path();
    if (at && path.length) track.push(...until(path, at), at);
    const heading = this.position?.heading_deg;
    this.map.setTrack(
      projection.line(track),
      at ? { at: projection.metres(at), heading: heading === null || heading === undefined ? null : ((90 - heading) * Math.PI) / 180, stale: this.isStale() } : null,
    );
    this.map.drive.setCaptures(this.captures().map((feature) => captureOf(feature, projection)));
  }

  private captures() {
    return this.recording.features.filter(({ properties }) => properties.role === "capture");
  }

  private isStale(): boolean {
    if (this.state?.state === "ended") return false;
    return !connection.connected || this.position === null || performance.now() - this.seenAt > STALE_MS;
  }

  private watchAge(): void {
    if (this.state?.state === "ended") return replace(this.age);
    const seconds = Math.round((performance.now() - this.seenAt) / 1000);
    const stale = this.isStale();
    const words = !stale ? "" : this.position ? t("position_old", { seconds }) : t("no_position");
    if (this.age.textContent !== words) this.age.textContent = words;
    if (stale) this.draw();
  }

  // A mission that has ended: its outcome, its drive by time, and the server's files.
  private finish(): void {
    const { state, mission } = this;
    const ended = this.recording.events.some(({ event }) => event === "mission");
    if (this.replay || !ended || !state || !mission || state.state !== "ended" || !this.map.projection) return;
    const run: Run = {
      outcome: "ran",
      authorization: { by: state.by, at: state.begun_at },
      status: state.status,
      reason: state.reason,
      success: state.status === "completed" && state.goals.every(({ outcome }) => outcome === "success"),
      travelled_m: state.travelled_m ?? 0,
      seconds: state.seconds ?? 0,
      charge_percent: state.charge_percent ?? 0,
      goals: state.goals,
      events: this.recording.events,
      told: this.recording.told,
      map: { type: "FeatureCollection", features: this.recording.features },
    };
    this.replay = new Replay(run, this.map, false);
    this.replay.seek(run.seconds);
    this.eventsBox.open = false;
    replace(this.told);
    const base = `/api/v1/missions/${encodeURIComponent(this.id)}`;
    replace(
      this.results,
      el(
        "section",
        { class: `card run ${run.success ? "success" : "failure"}`, "aria-labelledby": "results-title" },
        el("h2", { id: "results-title" }, t("results")),
        this.replay.root,
        el(
          "div",
          { class: "buttons" },
          state.report ? el("a", { class: "button", href: `${base}/report`, target: "_blank", rel: "noopener" }, t("report")) : null,
          FILES.map((file) => el("a", { class: "button", href: `${base}/${file}`, download: "" }, t("download", { name: file === "log" ? "events.jsonl" : file }))),
        ),
      ),
    );
  }

  private button(command: Command): HTMLButtonElement {
    const words = t(`command_${command}`);
    const button = el("button", { type: "button", class: command === "abort" ? "danger" : false, "data-command": command }, words);
    let sure = -Infinity;
    button.addEventListener("click", () => {
      // Nothing undoes an abort: it takes a second touch.
      if (command === "abort" && performance.now() - sure > SURE_MS) {
        sure = performance.now();
        button.textContent = t("command_sure");
        setTimeout(() => (button.textContent = words), SURE_MS);
        return;
      }
      button.textContent = words;
      void this.send(command, button);
    });
    return button;
  }

  private async send(command: Command, button: HTMLButtonElement): Promise<void> {
    const name = t(`command_${command}`);
    button.disabled = true;
    button.setAttribute("aria-busy", "true");
    replace(this.told, notice("info", t("command_sending", { command: name })));
    try {
      const { confirmed, sent, why } = await post<Confirmation>(`/missions/${encodeURIComponent(this.id)}/commands`, { command, lang: current() });
      const words = confirmed ? t("command_confirmed", { command: name }) : t(sent ? "command_waiting" : "command_not_sent", { command: name, why });
      replace(this.told, notice(confirmed ? "info" : sent ? "warning" : "error", words));
    } catch (problem) {
      replace(this.told, notice("error", t("command_not_sent", { command: name, why: "" })), problemNotice(problem));
    } finally {
      button.disabled = false;
      button.removeAttribute("aria-busy");
    }
  }
}

