// What the planner answers: the plan in words with its stops, a question, or what was not understood.

import { download, el, minutes, notice, sentence } from "./dom.js";
import { choiceClass } from "./map.js";

const TITLES = { planned: "The plan", clarify: "A question first", refused: "Not understood" };
const MANY = 8; // more stops of one line than this are counted

export const title = (answer) => TITLES[answer.outcome];

// The answer as elements. `map` lights up stops; `reply` takes the answer to a question.
export function render(answer, request, map, reply) {
  if (answer.outcome === "clarify") return question(answer, map, reply);
  if (answer.outcome === "refused") return refusal(answer, request);
  const parts = [...words(answer), ...problems(answer)];
  if (answer.read_back) parts.push(steps(answer, map), ...rest(answer), totals(answer));
  parts.push(document_(answer));
  return parts;
}

// A box to tick for each warning. Nothing is approved before all are ticked, here as on the server.
export const ticks = (warnings) =>
  warnings.map((text) => el("label", { class: "tick" }, el("input", { type: "checkbox", required: true, value: text }), el("span", {}, sentence(text))));

// The request with what became of its words; the legend names what occurs.
function words({ words: pieces }) {
  if (!pieces.length) return [];
  const shown = pieces.map((piece) => (piece.name ? el("span", { class: `word ${piece.role}`, title: piece.name }, piece.text) : piece.text));
  const names = new Map(pieces.filter((piece) => piece.name).map((piece) => [piece.role, piece.name]));
  const legend = [...names].map(([role, name]) => el("li", {}, el("span", { class: `word ${role}` }, name)));
  return [el("blockquote", { class: "said" }, shown), el("ul", { class: "word-legend", "aria-label": "How the words were used" }, legend)];
}

// The choices are buttons: a click plans again with the answer. Other words go into the request, or, where the planner
// takes them as an answer, into a field of their own.
function question({ question: asked, choices, free, places }, map, reply) {
  const choice = (text, k) => {
    const number = el("span", { class: places[k]?.length ? `badge choice-key ${choiceClass(k + 1)}` : "badge other" }, String(k + 1));
    const button = el("button", { type: "button", class: "example", onclick: () => reply(asked, text) }, number, text);
    for (const kind of ["pointerenter", "focus"]) button.addEventListener(kind, () => map.highlightChoice(k + 1));
    for (const kind of ["pointerleave", "blur"]) button.addEventListener(kind, () => map.highlightChoice(0));
    return el("li", {}, button);
  };
  const parts = [el("p", { class: "question" }, asked), el("ol", { class: "choices" }, choices.map(choice))];
  if (places.length) parts.push(el("p", { class: "hint" }, "Or tap its place on the map."));
  if (!free) return [...parts, el("p", { class: "hint" }, "Or write it in the request, and plan again.")];
  const words = el("input", { id: "other-words", maxlength: 2000, required: true });
  const send = (event) => (event.preventDefault(), reply(asked, words.value));
  const label = el("label", { for: "other-words" }, "In other words");
  return [...parts, el("form", { class: "field", onsubmit: send }, label, words, el("button", { type: "submit", class: "example" }, "Answer"))];
}

function refusal(answer, request) {
  const spans = answer.reasons.flatMap((reason) => reason.said);
  const said = spans.length ? [el("blockquote", { class: "said" }, marked(request, spans))] : [];
  const reasons = answer.reasons.map((reason) =>
    el("li", {}, sentence(reason.what), reason.advice ? el("span", { class: "advice" }, ` ${sentence(reason.advice)}`) : null),
  );
  const parts = [...said, el("ul", { class: "reasons" }, reasons)];
  if (answer.understood?.length) parts.push(el("p", { class: "hint" }, `Understood: ${answer.understood.join("; ")}`));
  if (answer.example) parts.push(el("p", {}, "Can be planned: ", el("q", {}, answer.example)));
  return parts;
}

// The request with the words in question marked. Ranges count characters, not the halves of surrogate pairs.
export function marked(request, spans) {
  const characters = Array.from(request);
  const parts = [];
  let done = 0;
  for (const [start, end] of [...spans].sort((a, b) => a[0] - b[0])) {
    if (end <= done) continue;
    const from = Math.max(start, done);
    parts.push(characters.slice(done, from).join(""), el("mark", {}, characters.slice(from, end).join("")));
    done = end;
  }
  parts.push(characters.slice(done).join(""));
  return parts;
}

function problems(answer) {
  return answer.problems.map((problem) =>
    notice(
      problem.severity,
      problem.where ? el("span", { class: "where" }, `${problem.where}: `) : null,
      sentence(problem.what),
      problem.advice ? el("span", { class: "advice" }, ` ${sentence(problem.advice)}`) : null,
    ),
  );
}

function steps(answer, map) {
  const stops = answer.map.features.filter((f) => f.properties.role === "stop").map((f) => f.properties);
  const list = el("ol", { class: "steps" }, answer.read_back.lines.map((line) => step(line, stops, map)));
  map.onstop = (nodes) => {
    for (const item of list.children) {
      item.classList.toggle("lit", nodes.some((node) => item.dataset.nodes.split(" ").includes(node)));
    }
  };
  return list;
}

function step(line, stops, map) {
  const nodes = [line.node, ...line.also];
  const here = stops.filter((stop) => stop.nodes.some((node) => nodes.includes(node)));
  const item = el(
    "li",
    { class: `indent-${Math.min(line.indent, 5)}`, "data-nodes": nodes.join(" "), tabindex: here.length ? 0 : false },
    el("span", { class: "number" }, line.number === null ? "" : String(line.number)),
    el("span", { class: "text" }, line.text, here.length ? badges(here) : null),
  );
  if (here.length) {
    for (const kind of ["pointerenter", "focus"]) item.addEventListener(kind, () => map.highlight(nodes));
    for (const kind of ["pointerleave", "blur"]) item.addEventListener(kind, () => map.highlight([]));
    item.addEventListener("click", () => map.reveal(nodes));
    item.addEventListener("keydown", (event) => event.key === "Enter" && map.reveal(nodes));
  }
  return item;
}

function badges(stops) {
  const words = stops.length === 1 ? `Stop ${stops[0].number}` : `${stops.length} stops`;
  const shown = stops.length > MANY ? [el("span", { class: "badge" }, `${stops.length} stops`)] : stops.map(badge);
  return el("span", { class: "badges", role: "img", "aria-label": `On the map: ${words}` }, shown);
}

const badge = (stop) => el("span", { class: stop.branch ? "badge other" : "badge" }, String(stop.number));

function rest({ read_back: back, headings }) {
  const part = (name, lines) =>
    lines.length ? [el("h3", {}, name), el("ul", { class: "plain" }, lines.map((line) => el("li", {}, sentence(line))))] : [];
  return ["times", "assumptions", "notes", "limits", "faults"].flatMap((kind) => part(headings[kind], back[kind]));
}

function totals({ read_back: back, headings }) {
  const { metres, seconds, percent, captures } = back.totals;
  const row = (name, ...cells) => el("tr", {}, el("th", { scope: "row" }, name), cells.map((cell) => el("td", {}, cell)));
  const figures = (figure, say) => [figure.mean, figure.p50, figure.p90].map(say);
  return el(
    "table",
    { class: "totals" },
    el("caption", {}, headings.totals),
    el("thead", {}, el("tr", {}, el("td", {}), ["mean", "p50", "p90"].map((kind) => el("th", { scope: "col" }, headings[kind])))),
    el(
      "tbody",
      {},
      row(headings.driving, ...figures(metres, (value) => `${Math.round(value)} m`)),
      row(headings.time, ...figures(seconds, minutes)),
      row(headings.battery, ...figures(percent, (value) => `${value.toFixed(0)} %`)),
      row(headings.captures, String(captures), "", ""),
    ),
  );
}

function document_(answer) {
  const save = () => download("task.xml", "application/xml", answer.xml);
  return el(
    "details",
    { class: "more" },
    el("summary", {}, "The Task (IEEE 1872.1, XML)"),
    el("p", { class: "hint" }, `Planned by: ${answer.planner}`),
    el("pre", { tabindex: 0 }, answer.xml),
    el("button", { type: "button", onclick: save }, "Download task.xml"),
  );
}
