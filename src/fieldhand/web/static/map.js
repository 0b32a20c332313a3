// The map: a site, a plan on it, a drive over it. Metres on an SVG whose view box is moved and zoomed.

import { $, svg } from "./dom.js";
import { placed, widthOf, worth } from "./names.js";

const METRES_PER_DEGREE = 111_320;
const CLOSEST_M = 8; // the view is never narrower than this
const CLOSEST_STOPS_PX = 17;
const STOP_PX = 26; // a numbered stop, from side to side
const DOT_PX = [2, 6]; // a stop without a number: least and largest radius
const NAME_PX = { zone: 12, gate: 11, block: 13, row: 11 }; // letters
const ROW_STEPS = [1, 2, 5, 10, 20, 50, 100]; // every how many rows one has its number, so that they lie
const ROW_PX = 22; // so far from each other
const SMALL = 0.4; // work in so small a part of the site is looked at from near
const OVERVIEW_PX = 84;
const TAP_PX = 6; // a finger that moves less has tapped
const MARKER = { start: "S", end: "E", charger: "C" };

export class FieldMap {
  constructor() {
    this.root = $("map");
    this.info = $("map-info");
    this.layers = {};
    for (const name of ["zones", "blocks", "rows", "trees", "paths", "driven", "names", "markers", "stops", "choices", "captures", "robot"]) {
      this.layers[name] = svg("g", { class: `layer-${name}` });
      this.root.append(this.layers[name]);
    }
    this.overview = svg("svg", { class: "overview", "aria-hidden": "true" });
    this.root.append(this.overview);
    this.signs = []; // drawn at the same size whatever the zoom
    this.names = []; // of zones, gates, blocks and rows, what matters most first
    this.onstop = () => {};
    this.#listen();
    new ResizeObserver(() => this.#keepShape()).observe(this.root);
  }

  clear() {
    for (const layer of Object.values(this.layers)) layer.replaceChildren();
    this.signs = [];
    this.names = [];
    this.overview.replaceChildren();
    this.info.textContent = "";
  }

  // A site as GeoJSON; forgets what was drawn before.
  showSite(features) {
    this.clear();
    this.#originFrom(features);
    const trees = features.filter((f) => f.properties.role === "tree");
    const radius = this.#treeRadius(trees);
    for (const feature of features) {
      const { role } = feature.properties;
      if (role === "zone") this.#zone(feature);
      if (role === "block") this.#block(feature);
      if (role === "row") this.#row(feature);
      if (role === "tree") this.#tree(feature, radius);
      if (role === "marker") this.#marker(feature);
      if (role === "gate") this.#gate(feature);
    }
    this.#nameRows(features.filter((f) => f.properties.role === "row"));
    this.names.sort((a, b) => a.worth - b.worth);
    this.frame = svg("rect", { class: "view" });
    this.overview.append(svg("rect", { class: "sheet" }), ...this.#outlines(features), this.frame);
    this.fit();
  }

  // Legs and numbered stops of a plan.
  showPlan(features) {
    this.clearPlan();
    for (const { geometry, properties } of features) {
      if (properties.role === "path") {
        const kind = properties.branch ? "path other" : properties.home ? "path home" : "path";
        this.layers.paths.append(svg("polyline", { class: kind, points: this.#points(geometry.coordinates) }));
      }
    }
    const stops = features.filter((f) => f.properties.role === "stop");
    // The first stops lie on top: where they crowd, the plan is read from its beginning.
    for (const stop of stops.reverse()) this.#stop(stop, stops.length);
    const at = [...this.layers.stops.children].map((s) => s.at);
    this.closest = closest(at);
    if (at.length && this.#isSmall(at)) this.fit(at, 0.5);
    else this.#crowd();
  }

  // The places that the choices of a question mean; a tap on one takes the choice with the fewest places that holds it.
  showChoices(features, choices, choose) {
    this.clearPlan();
    const numbered = new Set();
    const marks = features.filter((f) => f.properties.role === "choice").map((f) => this.#choice(f, choices, choose));
    for (const sign of marks.filter((one) => one.numbered)) {
      // Where numbers would cover each other, one of each choice is left.
      sign.classList.toggle("first", !numbered.has(sign.dataset.numbers));
      numbered.add(sign.dataset.numbers);
    }
    for (const sign of marks.filter((one) => one.numbered).reverse()) this.layers.choices.append(sign);
    this.closestChoice = closest(marks.filter((one) => one.numbered).map((one) => one.at));
    this.#crowd();
  }

  // Marks the places of a choice by its number, counted from 1; 0 for none.
  highlightChoice(number) {
    for (const sign of this.layers.choices.children) {
      sign.classList.toggle("lit", sign.dataset.numbers.split(" ").includes(String(number)));
    }
  }

  clearPlan() {
    this.clearDrive();
    for (const name of ["paths", "stops", "choices"]) this.layers[name].replaceChildren();
    this.numbered = [];
    this.signs = this.signs.filter((s) => s.isConnected);
    this.info.textContent = "";
  }

  clearDrive() {
    for (const name of ["driven", "captures", "robot"]) this.layers[name].replaceChildren();
    this.signs = this.signs.filter((s) => s.isConnected);
    this.layers.stops.classList.remove("faint");
    this.layers.paths.classList.remove("faint");
  }

  // What to draw of a drive; Flight decides when.
  startDrive() {
    this.clearDrive();
    this.layers.stops.classList.add("faint");
    this.layers.paths.classList.add("faint");
    this.track = svg("polyline", { class: "driven" });
    this.layers.driven.append(this.track);
    this.robot = this.#sign(this.layers.robot, "robot", [0, 0], [svg("circle", { r: 9 }), svg("circle", { r: 3.5, class: "eye" })]);
  }

  setTrack(points, at) {
    this.track.setAttribute("points", points.map((p) => p.join(",")).join(" "));
    if (at) this.#place(this.robot, at);
  }

  addCapture(feature) {
    const { status, action, place } = feature.properties;
    const sign = this.#sign(this.layers.captures, `capture ${status}`, this.metres(feature.geometry.coordinates), [
      svg("circle", { r: 6 }),
      svg("title", {}, `${action.replaceAll("_", " ")} at ${place}: ${status}`),
    ]);
    return sign;
  }

  // Marks the stops of these nodes; none for none.
  highlight(nodes) {
    for (const stop of this.layers.stops.children) {
      stop.classList.toggle("lit", nodes.some((n) => stop.dataset.nodes.split(" ").includes(n)));
    }
  }

  // Moves the view so that the stops of these nodes can be seen.
  reveal(nodes) {
    const lit = [...this.layers.stops.children].filter((s) => nodes.some((n) => s.dataset.nodes.split(" ").includes(n)));
    if (!lit.length) return;
    const seen = lit.every(({ at: [x, y] }) => {
      const { view } = this;
      return x > view.x && x < view.x + view.w && y > view.y && y < view.y + view.h;
    });
    if (!seen) this.fit(lit.map((s) => s.at), 0.5);
  }

  metres([lon, lat]) {
    const { lon: lon0, lat: lat0 } = this.origin;
    return [(lon - lon0) * METRES_PER_DEGREE * Math.cos((lat0 * Math.PI) / 180), (lat0 - lat) * METRES_PER_DEGREE];
  }

  // Everything, or these points with room around them, in view.
  fit(points = this.all, room = 0.06) {
    const xs = points.map((p) => p[0]);
    const ys = points.map((p) => p[1]);
    const [left, right] = extremes(xs);
    const [top, bottom] = extremes(ys);
    const around = Math.max(right - left, bottom - top, 15) * room + 4;
    this.wanted = { x: left - around, y: top - around, w: right - left + 2 * around, h: bottom - top + 2 * around };
    this.view = this.wanted;
    this.#keepShape();
    if (points === this.all) this.whole = { ...this.view };
    this.root.classList.toggle("closer", this.view.w < 0.95 * this.whole.w);
  }

  zoom(factor, at = null) {
    const { view, whole } = this;
    const w = Math.min(Math.max(view.w * factor, CLOSEST_M), whole.w * 1.5);
    const real = w / view.w;
    const [x, y] = at ?? [view.x + view.w / 2, view.y + view.h / 2];
    this.view = { x: x - (x - view.x) * real, y: y - (y - view.y) * real, w, h: view.h * real };
    this.wanted = this.view;
    // Zoomed in, a finger moves the map; else it scrolls the page.
    this.root.classList.toggle("closer", w < 0.95 * whole.w);
    this.#draw();
  }

  pan(dx, dy) {
    this.view = { ...this.view, x: this.view.x + dx, y: this.view.y + dy };
    this.wanted = this.view;
    this.#draw();
  }

  #originFrom(features) {
    const all = features.flatMap((f) => positions(f.geometry));
    const [west, east] = extremes(all.map((p) => p[0]));
    const [south, north] = extremes(all.map((p) => p[1]));
    this.origin = { lon: (west + east) / 2, lat: (south + north) / 2 };
    this.all = all.map((p) => this.metres(p));
  }

  #treeRadius(trees) {
    const points = trees.map((t) => this.metres(t.geometry.coordinates));
    const [left, right] = extremes(points.map((p) => p[0]));
    const [top, bottom] = extremes(points.map((p) => p[1]));
    const spacing = Math.sqrt(((right - left + 5) * (bottom - top + 5)) / Math.max(points.length, 1));
    return Math.min(Math.max(spacing * 0.24, 0.4), 3);
  }

  #zone({ geometry, properties }) {
    const d = geometry.coordinates.map((ring) => `M${this.#points(ring)}Z`).join("");
    const called = properties.name || properties.kind.replaceAll("_", " ");
    if (properties.kind !== "boundary") this.#name("zone", called, middle(geometry.coordinates[0].map((p) => this.metres(p))), 1);
    this.layers.zones.append(svg("path", { d, class: `zone ${properties.kind}`, "fill-rule": "evenodd" }, svg("title", {}, called)));
  }

  #block({ geometry, properties }) {
    const d = geometry.coordinates.map((ring) => `M${this.#points(ring)}Z`).join("");
    this.layers.blocks.append(svg("path", { d, class: "block" }, svg("title", {}, properties.name)));
    const points = geometry.coordinates[0].map((p) => this.metres(p));
    const [left, right] = extremes(points.map((p) => p[0]));
    const [top, bottom] = extremes(points.map((p) => p[1]));
    const name = this.#name("block", properties.name, middle(points), 3);
    name.ends = [[(left + right) / 2, bottom], [(left + right) / 2, top]];
  }

  // Names at both ends of each row; of many there is room for some, the round numbers first.
  #nameRows(rows) {
    const last = Math.max(...rows.map((f) => Number(f.properties.name) || 0), 0);
    this.rowsApart = closest(rows.map((f) => this.metres(f.geometry.coordinates[0])));
    for (const { geometry, properties } of rows) {
      const points = geometry.coordinates.map((p) => this.metres(p));
      const number = Number(properties.name);
      for (const [end, other] of [[points[0], points.at(-1)], [points.at(-1), points[0]]]) {
        const length = distance(end, other) || 1;
        const name = this.#name("row", properties.name, end, 4 + (Number.isInteger(number) ? worth(number, last) : 5));
        name.number = number;
        name.out = [(end[0] - other[0]) / length, (end[1] - other[1]) / length];
      }
    }
  }

  #gate({ geometry, properties }) {
    const at = this.metres(geometry.coordinates);
    this.#sign(this.layers.markers, "gate", at, [svg("rect", { x: -5, y: -5, width: 10, height: 10 }), svg("title", {}, properties.name)]);
    this.#name("gate", properties.name, at, 2).beside = true;
  }

  // A name at a place; where it stands, or whether at all, is decided whenever the view changes.
  #name(kind, text, at, worthOf) {
    const sign = svg("g", { class: `name ${kind}` }, svg("text", {}, text));
    this.layers.names.append(sign);
    const name = { kind, text, at, worth: worthOf, sign };
    this.names.push(name);
    return name;
  }

  #row(feature) {
    this.layers.rows.append(svg("polyline", { class: "tree-row", points: this.#points(feature.geometry.coordinates) }));
  }

  #tree({ geometry, properties }, radius) {
    const [cx, cy] = this.metres(geometry.coordinates);
    const tree = svg("circle", { class: "tree", cx, cy, r: radius });
    tree.words = treeWords(properties);
    this.layers.trees.append(tree);
  }

  #marker({ geometry, properties }) {
    this.#sign(this.layers.markers, `marker ${properties.name in MARKER ? properties.name : "point"}`, this.metres(geometry.coordinates), [
      svg("rect", { x: -9, y: -9, width: 18, height: 18, rx: 4 }),
      svg("text", { y: 0.5 }, MARKER[properties.name] ?? properties.name.charAt(0).toUpperCase()),
      svg("title", {}, properties.name),
    ]);
  }

  #stop({ geometry, properties }, last) {
    const label = String(properties.number);
    const sign = this.#sign(this.layers.stops, properties.branch ? "stop other" : "stop", this.metres(geometry.coordinates), [
      svg("circle", { r: label.length > 2 ? 13 : 11 }),
      svg("text", { y: 0.5 }, label),
      svg("title", {}, `Stop ${label}: ${properties.kind} ${properties.place}`),
    ]);
    sign.dataset.nodes = properties.nodes.join(" ");
    sign.worth = worth(properties.number, last);
    sign.words = `Stop ${label}: ${properties.kind} ${properties.place}${properties.branch ? ", only on some branches" : ""}`;
    sign.addEventListener("pointerenter", () => this.onstop(properties.nodes));
    sign.addEventListener("pointerleave", () => this.onstop([]));
  }

  #choice({ geometry, properties }, choices, choose) {
    const { numbers, labelled, kind, place } = properties;
    const label = [...numbers].sort((a, b) => a - b).join(", ");
    const words = `${kind} ${place}: ${numbers.map((n) => `${n}. ${choices[n - 1]}`).join("; ")}`;
    const sign = this.#sign(this.layers.choices, `choice ${choiceClass(numbers[0])}`, this.metres(geometry.coordinates), [
      svg("circle", { r: labelled ? 9 + 1.7 * label.length : 6 }),
      labelled ? svg("text", { y: 0.5 }, label) : null,
      svg("title", {}, words),
    ]);
    sign.dataset.numbers = numbers.join(" ");
    sign.numbered = labelled;
    sign.words = words.charAt(0).toUpperCase() + words.slice(1);
    sign.addEventListener("click", () => choose(choices[numbers[0] - 1]));
    return sign;
  }

  #sign(layer, kind, at, children) {
    const sign = svg("g", { class: kind }, children);
    layer.append(sign);
    this.signs.push(sign);
    this.#place(sign, at);
    return sign;
  }

  #place(sign, at) {
    sign.at = at;
    sign.setAttribute("transform", `translate(${at[0]} ${at[1]}) scale(${this.perPixel ?? 1})`);
  }

  #points(coordinates) {
    return coordinates.map((p) => this.metres(p).map((v) => v.toFixed(2)).join(",")).join(" ");
  }

  // The view box takes the shape of the element, so that a metre is as long both ways. It is taken from what was wanted,
  // not from the last shape, or every turn of a phone would make it wider.
  #keepShape() {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (!this.wanted || !width || !height) return;
    const { x, y, w, h } = this.wanted;
    const perPixel = Math.max(w / width, h / height);
    this.view = { x: x + (w - perPixel * width) / 2, y: y + (h - perPixel * height) / 2, w: perPixel * width, h: perPixel * height };
    this.#draw();
  }

  #draw() {
    const { x, y, w, h } = this.view;
    this.root.setAttribute("viewBox", `${x} ${y} ${w} ${h}`);
    this.perPixel = w / (this.root.clientWidth || 600);
    for (const sign of this.signs) this.#place(sign, sign.at);
    this.#crowd();
    this.#writeNames();
    this.#showOverview();
  }

  // Pixels on the page from the upper left of the map.
  #pixels([x, y]) {
    return [(x - this.view.x) / this.perPixel, (y - this.view.y) / this.perPixel];
  }

  get #sheet() {
    return [0, 0, this.view.w / this.perPixel, this.view.h / this.perPixel];
  }

  #writeNames() {
    const step = ROW_STEPS.find((one) => (one * this.rowsApart) / this.perPixel >= ROW_PX) ?? ROW_STEPS.at(-1);
    const wanted = this.names.map((name) => {
      if (name.number > 1 && name.number % step) return { width: 0, height: 0, spots: [] };
      const size = NAME_PX[name.kind];
      const width = widthOf(name.text, size);
      return { width, height: size * 1.2, spots: this.#spots(name, width, size * 1.2) };
    });
    const box = (half) => ({ at }) => {
      const [x, y] = this.#pixels(at);
      return [x - half, y - half, x + half, y + half];
    };
    const signs = [...[...this.layers.markers.children].map(box(10)), ...(this.numbered ?? []).map(box(STOP_PX / 2))];
    placed(wanted, this.#sheet, signs).forEach((spot, k) => {
      const { sign } = this.names[k];
      sign.classList.toggle("hidden", !spot);
      if (!spot) return;
      this.#place(sign, [this.view.x + spot[0] * this.perPixel, this.view.y + spot[1] * this.perPixel]);
    });
  }

  // Where the middle of a name may stand, the best first.
  #spots({ at, out, ends, beside }, width, height) {
    const [x, y] = this.#pixels(at);
    if (out) return [5, 12].map((gap) => gap + (Math.abs(out[0]) * width + Math.abs(out[1]) * height) / 2).map((away) => [x + out[0] * away, y + out[1] * away]);
    if (ends) {
      const [below, above] = ends.map((end) => this.#pixels(end));
      return [...[24, 34].flatMap((gap) => [[below[0], below[1] + gap], [above[0], above[1] - gap]]), [x, y]];
    }
    if (beside) return [[x, y + 21], [x, y - 21], [x + width / 2 + 14, y], [x - width / 2 - 14, y]];
    return [[x, y]];
  }

  // Where the view lies on the site, in a corner, once it shows a part alone.
  #showOverview() {
    const { view, whole, perPixel } = this;
    const near = whole && view.w < 0.6 * whole.w;
    this.overview.classList.toggle("hidden", !near);
    if (!near) return;
    const [left, right] = extremes(this.all.map((p) => p[0]));
    const [top, bottom] = extremes(this.all.map((p) => p[1]));
    const wide = Math.max(right - left, 1) * 1.1;
    const tall = Math.max(bottom - top, 1) * 1.1;
    const scale = Math.min((OVERVIEW_PX * perPixel) / wide, (0.35 * view.h) / tall);
    const box = { x: view.x + 6 * perPixel, y: view.y + 6 * perPixel, width: wide * scale, height: tall * scale };
    const sheet = { x: (left + right - wide) / 2, y: (top + bottom - tall) / 2, width: wide, height: tall };
    set(this.overview, { ...box, viewBox: `${sheet.x} ${sheet.y} ${wide} ${tall}` });
    set(this.overview.firstChild, sheet);
    set(this.frame, { x: view.x, y: view.y, width: view.w, height: view.h });
  }

  #outlines(features) {
    return features
      .filter(({ properties: { role, kind } }) => role === "block" || (role === "zone" && kind !== "zone"))
      .map(({ geometry, properties }) => {
        const d = geometry.coordinates.map((ring) => `M${this.#points(ring)}Z`).join("");
        return svg("path", { d, class: properties.role === "block" ? "block" : `zone ${properties.kind}`, "fill-rule": "evenodd" });
      });
  }

  // Whether points lie in a small part of the site.
  #isSmall(points) {
    return [0, 1].every((axis) => {
      const [low, high] = extremes(points.map((p) => p[axis]));
      const [least, most] = extremes(this.all.map((p) => p[axis]));
      return high - low < SMALL * (most - least);
    });
  }

  // Numbers that would cover each other give way to dots until the map is zoomed in: the ends and round ones stay.
  #crowd() {
    const stops = [...this.layers.stops.children].sort((a, b) => a.worth - b.worth);
    const wanted = stops.map(({ at }) => ({ width: STOP_PX, height: STOP_PX, spots: [this.#pixels(at)] }));
    const room = placed(wanted, [-Infinity, -Infinity, Infinity, Infinity]);
    stops.forEach((stop, k) => stop.classList.toggle("small", !room[k]));
    const numbered = stops.filter((_, k) => room[k]).reverse();
    if (this.numbered?.length !== numbered.length || numbered.some((stop, k) => stop !== this.numbered[k])) {
      this.layers.stops.append(...numbered); // so that they lie above the dots
      this.numbered = numbered;
    }
    const dot = Math.min(Math.max((0.45 * (this.closest ?? Infinity)) / this.perPixel, DOT_PX[0]), DOT_PX[1]);
    this.layers.stops.style.setProperty("--dot", `${dot}px`);
    this.layers.stops.classList.toggle("crowded", (this.closest ?? Infinity) / this.perPixel < CLOSEST_STOPS_PX);
    this.layers.choices.classList.toggle("crowded", (this.closestChoice ?? Infinity) / this.perPixel < CLOSEST_STOPS_PX);
  }

  #at(event) {
    const box = this.root.getBoundingClientRect();
    return [
      this.view.x + ((event.clientX - box.left) / box.width) * this.view.w,
      this.view.y + ((event.clientY - box.top) / box.height) * this.view.h,
    ];
  }

  #listen() {
    $("zoom-in").addEventListener("click", () => this.zoom(0.6));
    $("zoom-out").addEventListener("click", () => this.zoom(1 / 0.6));
    $("zoom-fit").addEventListener("click", () => this.fit());
    this.root.addEventListener("keydown", (event) => this.#key(event));
    this.root.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    this.root.addEventListener("pointerover", (event) => this.#tell(event.target));
    this.root.addEventListener("pointerdown", (event) => this.#tell(event.target));
    this.#listenToFingers();
  }

  #tell(target) {
    const words = target.words ?? target.parentNode?.words;
    if (words) this.info.textContent = words;
  }

  #key(event) {
    const step = this.view.w * 0.15;
    const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
    if (event.key in moves) this.pan(...moves[event.key]);
    else if (event.key === "+" || event.key === "=") this.zoom(0.75);
    else if (event.key === "-") this.zoom(1 / 0.75);
    else if (event.key === "0") this.fit();
    else return;
    event.preventDefault();
  }

  // Where the map stands in the way of the page, the wheel belongs to the page.
  #wheel(event) {
    if (!event.ctrlKey && !matchMedia("(min-width: 900px)").matches) return;
    event.preventDefault();
    this.zoom(Math.exp(Math.min(Math.max(event.deltaY, -80), 80) * 0.004), this.#at(event));
  }

  #listenToFingers() {
    const fingers = new Map();
    let first = null; // where a finger came down that has not moved yet: it may be a tap
    this.root.addEventListener("pointerdown", (event) => {
      first = fingers.size ? null : [event.clientX, event.clientY];
      fingers.set(event.pointerId, this.#at(event));
    });
    this.root.addEventListener("pointermove", (event) => {
      const from = fingers.get(event.pointerId);
      if (!from || (first && distance(first, [event.clientX, event.clientY]) < TAP_PX)) return;
      first = null;
      if (!this.root.hasPointerCapture(event.pointerId)) this.root.setPointerCapture(event.pointerId);
      const to = this.#at(event);
      const other = [...fingers.entries()].find(([id]) => id !== event.pointerId)?.[1];
      if (other) {
        this.zoom(Math.min(Math.max(distance(from, other) / Math.max(distance(to, other), 0.01), 0.5), 2), other);
        fingers.set(event.pointerId, this.#at(event));
      } else this.pan(from[0] - to[0], from[1] - to[1]);
    });
    for (const kind of ["pointerup", "pointercancel"]) {
      this.root.addEventListener(kind, (event) => fingers.delete(event.pointerId));
    }
  }
}

// Choices are told apart by four colours, which come round again; the numbers say the rest.
export const choiceClass = (number) => `c${((number - 1) % 4) + 1}`;

function treeWords({ id, row, attributes }) {
  const rest = Object.entries(attributes)
    .filter(([name]) => !["id", "row", "marker-symbol", "kind"].includes(name))
    .map(([name, value]) => `${name.replaceAll("_", " ")} ${value}`);
  return [`Tree ${id}`, row ? `row ${row}` : "", ...rest].filter(Boolean).join(", ");
}

function positions({ type, coordinates }) {
  if (type === "Point") return [coordinates];
  return type === "Polygon" ? coordinates.flat() : coordinates;
}

// The distance that all but a few of the points keep from their nearest neighbour.
function closest(points) {
  const nearest = points.map((p, i) => Math.min(...points.map((q, k) => (k === i ? Infinity : distance(p, q)))));
  return nearest.sort((a, b) => a - b)[Math.floor(nearest.length / 4)];
}

function middle(points) {
  const [left, right] = extremes(points.map((p) => p[0]));
  const [top, bottom] = extremes(points.map((p) => p[1]));
  return [(left + right) / 2, (top + bottom) / 2];
}

function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
}

function extremes(values) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : [0, 0];
}

const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
