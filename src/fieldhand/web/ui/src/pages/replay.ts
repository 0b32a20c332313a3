// A simulated mission: its outcome, and its drive over the map by a time slider.

import { statusWords, t } from "../lang";
import { el, icon, notice, replace, sentence, type Child } from "../lib/dom";
import { clock, duration, metres, number } from "../lib/figures";
import type { Feature, Run } from "../lib/types";
import type { Capture } from "../map/drive_layer";
import type { FieldMap } from "../map/field_map";
import { upTo, type Point } from "../map/geometry";
import { captureOf, captureTable, goalList, localTime, readingChooser, resultFiles } from "./results";

const PLAY_MS = 14_000; // however long the mission was

interface Leg {
  line: Point[];
  t: number;
  until: number;
}

export class Replay {
  readonly root = el("div", {});
  private readonly legs: Leg[];
  private readonly captures: Capture[];
  private readonly length: number;
  private now = 0;
  private playing = false;
  private lines: { t: number; item: HTMLElement }[] = [];
  private readonly button = el("button", { type: "button", class: "play", onclick: () => (this.playing ? this.pause() : this.play()) });
  private readonly slider: HTMLInputElement;
  private readonly time = el("span", { class: "time" });
  private readonly list = el("ol", { class: "events", tabindex: 0, "aria-label": t("events") });

  constructor(
    private readonly run: Run,
    private readonly map: FieldMap,
    private readonly offersFiles = true,
  ) {
    const projection = map.projection!;
    const of = (role: string) => run.map.features.filter((f) => f.properties.role === role);
    this.legs = of("leg").map(({ geometry, properties }) => ({
      line: projection.line(geometry.coordinates as [number, number][]),
      t: properties["t"],
      until: properties["until"],
    }));
    this.captures = of("capture").map((feature) => captureOf(feature, projection));
    this.length = Math.max(run.seconds, 1);
    this.slider = el("input", { type: "range", min: 0, max: this.length, step: "any", value: 0, "aria-label": t("time_in_mission") });
    this.slider.addEventListener("input", () => {
      const to = Number(this.slider.value);
      this.pause();
      this.seek(to);
    });
    replace(this.root, this.render(of("capture")));
    this.buttons();
  }

  private render(captures: Feature[]): Child[] {
    const { run } = this;
    const facts = { metres: metres(run.travelled_m), time: duration(run.seconds), percent: number(run.charge_percent) };
    this.lines = run.told.flatMap((words, k) => (words ? [{ t: run.events[k]!.t, item: el("li", {}, words.trim()) }] : []));
    this.list.append(...this.lines.map(({ item }) => item));
    const log = run.events.map((event) => `${JSON.stringify(event)}\n`).join("");
    return [
      run.reason ? notice("warning", sentence(run.reason)) : null,
      el("p", { class: "summary" }, t("driven_summary", facts)),
      goalList(run.goals),
      el("div", { class: "player" }, this.button, this.slider, this.time),
      readingChooser(this.captures, this.map),
      captureTable(this.captures),
      el("details", { class: "more" }, el("summary", {}, `${t("events")} (${this.lines.length})`), this.list),
      this.offersFiles && resultFiles(captures, log),
      this.offersFiles && el("p", { class: "hint" }, t("approved_by", { name: run.authorization.by, time: localTime(run.authorization.at) })),
    ];
  }

  play(): void {
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return this.seek(this.length);
    if (this.now >= this.length) this.seek(0);
    this.playing = true;
    this.buttons();
    let before = performance.now();
    const step = (at: number) => {
      if (!this.playing) return;
      this.seek(this.now + ((at - before) / PLAY_MS) * this.length);
      before = at;
      if (this.now < this.length) requestAnimationFrame(step);
      else this.pause();
    };
    requestAnimationFrame(step);
  }

  pause(): void {
    this.playing = false;
    this.buttons();
  }

  // Map, slider and list as they were so many seconds into the mission.
  seek(to: number): void {
    this.now = Math.min(Math.max(to, 0), this.length);
    const track: Point[] = [];
    let heading: number | null = null;
    for (const { line, t: begun, until } of this.legs) {
      if (begun > this.now) break;
      const part = upTo(line, until > begun ? Math.min((this.now - begun) / (until - begun), 1) : 1);
      for (const point of part.points) track.push(point);
      heading = part.heading;
    }
    const at = track.at(-1) ?? this.legs[0]?.line[0] ?? this.end();
    this.map.setTrack(track, at ? { at, heading, stale: false } : null);
    this.map.drive.setCaptures(this.captures.filter((capture) => capture.t <= this.now));
    this.slider.value = String(this.now);
    this.slider.setAttribute("aria-valuetext", clock(this.now));
    this.time.textContent = `${clock(this.now)} / ${clock(this.length)}`;
    this.follow();
  }

  private end(): Point | null {
    const end = this.run.map.features.find((f) => f.properties.role === "end");
    return end?.geometry.type === "Point" ? this.map.projection!.metres(end.geometry.coordinates) : null;
  }

  private follow(): void {
    let now: HTMLElement | null = null;
    for (const { t: at, item } of this.lines) {
      item.classList.toggle("ahead", at > this.now);
      item.classList.remove("now");
      if (at <= this.now) now = item;
    }
    now?.classList.add("now");
    // The list scrolls by itself, the page never does.
    if (now) this.list.scrollTop = now.offsetTop - this.list.offsetTop - this.list.clientHeight / 2;
  }

  private buttons(): void {
    replace(this.button, this.playing ? icon("M8 5v14M16 5v14") : icon("M8 5l11 7-11 7z"), this.playing ? t("pause") : t("play"));
  }
}

export const replayTitle = (run: Run): string => (run.success ? t("done") : t("mission_status", { status: statusWords(run.status) }));
