// What came of a mission: its outcomes, its events, and the drive over the map.

import { clock, download, el, minutes, notice, sentence } from "./dom.js";

const MARK = { success: "✓", failure: "✗", indeterminate: "?" };
const PLAY_MS = 14_000; // however long the mission was

export const title = (run) => (run.success ? "Done" : `Mission ${run.status}`);

export class Flight {
  constructor(run, map) {
    this.run = run;
    this.map = map;
    const features = run.map.features;
    const of = (role) => features.filter((f) => f.properties.role === role);
    this.legs = of("leg").map((f) => leg(f.geometry.coordinates.map((p) => map.metres(p)), f.properties));
    this.captures = of("capture");
    this.length = Math.max(run.seconds, 1);
    this.now = 0;
    this.shown = 0;
    map.startDrive();
  }

  render() {
    const { run } = this;
    const battery = `battery at ${Math.round(run.charge_percent)} %`;
    const summary = `${Math.round(run.travelled_m)} m driven in ${minutes(run.seconds)}, ${battery}.`;
    const goals = run.goals.map((goal) =>
      el("li", { class: goal.outcome }, el("span", { class: "mark", role: "img", "aria-label": goal.outcome }, MARK[goal.outcome]), el("span", {}, `${goal.name}: ${goal.why}`)),
    );
    this.lines = run.told
      .map((words, i) => ({ words, t: run.events[i].t }))
      .filter(({ words }) => words)
      .map(({ words, t }) => ({ t, item: el("li", {}, words.trimEnd()) }));
    this.list = el("ol", { class: "events", tabindex: 0, "aria-label": "Events" }, this.lines.map((line) => line.item));
    const save = () => download("events.jsonl", "application/jsonl", run.events.map((e) => `${JSON.stringify(e)}\n`).join(""));
    return [
      run.reason ? notice("warning", sentence(run.reason)) : null,
      el("p", { class: "summary" }, summary),
      el("h3", {}, "Goals"),
      el("ul", { class: "goals" }, goals),
      el("h3", {}, "The drive"),
      this.#player(),
      this.list,
      el("button", { type: "button", onclick: save }, "Download events.jsonl"),
      el("p", { class: "hint" }, `Approved by ${run.authorization.by} at ${run.authorization.at}. This was a simulation.`),
    ].filter(Boolean);
  }

  play() {
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return this.seek(this.length);
    if (this.now >= this.length) this.seek(0);
    this.playing = true;
    this.#buttons();
    let before = performance.now();
    const step = (at) => {
      if (!this.playing) return;
      this.seek(this.now + ((at - before) / PLAY_MS) * this.length);
      before = at;
      if (this.now < this.length) requestAnimationFrame(step);
      else this.pause();
    };
    requestAnimationFrame(step);
  }

  pause() {
    this.playing = false;
    this.#buttons();
  }

  // The map and the list as they were so many seconds into the mission.
  seek(t) {
    this.now = Math.min(Math.max(t, 0), this.length);
    const { points, at } = this.#track();
    this.map.setTrack(points, at);
    if (this.captures.slice(0, this.shown).some((f) => f.properties.t > this.now)) {
      this.signs.forEach((sign) => sign.remove());
      this.shown = 0;
    }
    if (this.shown === 0) this.signs = [];
    while (this.shown < this.captures.length && this.captures[this.shown].properties.t <= this.now) {
      this.signs.push(this.map.addCapture(this.captures[this.shown++]));
    }
    this.slider.value = String(this.now);
    this.slider.setAttribute("aria-valuetext", clock(this.now));
    this.time.textContent = `${clock(this.now)} / ${clock(this.length)}`;
    this.#follow();
  }

  // Where it has driven and where it is.
  #track() {
    const points = [];
    for (const one of this.legs) {
      if (one.t > this.now) break;
      const share = one.until > one.t ? Math.min((this.now - one.t) / (one.until - one.t), 1) : 1;
      points.push(...upTo(one, share));
    }
    const first = this.legs[0]?.points[0] ?? this.#end();
    return { points, at: points.at(-1) ?? first };
  }

  #end() {
    const end = this.run.map.features.find((f) => f.properties.role === "end");
    return end ? this.map.metres(end.geometry.coordinates) : null;
  }

  #follow() {
    let current = null;
    for (const { t, item } of this.lines) {
      item.classList.toggle("ahead", t > this.now);
      if (t <= this.now) current = item;
    }
    if (current === this.current) return;
    this.current?.classList.remove("now");
    this.current = current;
    current?.classList.add("now");
    // The list scrolls by itself, the page never does.
    if (current) this.list.scrollTop = current.offsetTop - this.list.offsetTop - this.list.clientHeight / 2;
  }

  #player() {
    this.button = el("button", { type: "button", class: "play", onclick: () => (this.playing ? this.pause() : this.play()) });
    this.slider = el("input", { type: "range", min: 0, max: this.length, step: "any", "aria-label": "Time in the mission" });
    this.slider.addEventListener("input", () => {
      const to = Number(this.slider.value);
      this.pause();
      this.seek(to);
    });
    this.time = el("span", { class: "time" });
    this.#buttons();
    return el("div", { class: "player" }, this.button, this.slider, this.time);
  }

  #buttons() {
    this.button.textContent = this.playing ? "Pause" : "Play";
  }
}

function leg(points, { t, until }) {
  const lengths = points.slice(1).map((p, i) => Math.hypot(p[0] - points[i][0], p[1] - points[i][1]));
  return { points, t, until, lengths, whole: lengths.reduce((a, b) => a + b, 0) };
}

// The points of a leg up to a share of its length.
function upTo({ points, lengths, whole }, share) {
  let left = share * whole;
  const passed = [points[0]];
  for (const [i, length] of lengths.entries()) {
    const [a, b] = [points[i], points[i + 1]];
    if (length >= left) {
      const part = length ? left / length : 1;
      passed.push([a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part]);
      break;
    }
    passed.push(b);
    left -= length;
  }
  return passed;
}
