// The planner's answer: the plan in words with its stops, a question, or what was not understood.

import { t, tn } from "../lang";
import { el, notice, save, sentence, type Child } from "../lib/dom";
import { duration, metres, number } from "../lib/figures";
import type { Answer, Clarify, Figure, Planned, ReadBack, ReadBackLine, Refused, Word } from "../lib/types";
import type { FieldMap } from "../map/field_map";
import { choiceColour, type Stop } from "../map/plan_layer";

const MANY = 8; // more stops of one line than this are counted

export interface Asking {
  request: string;
  reply(question: string, answer: string): void;
  take(request: string): void;
}

export const answerTitle = (answer: Answer): string => t(answer.outcome === "planned" ? "the_plan" : answer.outcome === "clarify" ? "a_question" : "not_understood");

export function renderAnswer(answer: Answer, map: FieldMap, asking: Asking): Child[] {
  if (answer.outcome === "clarify") return question(answer, map, asking);
  if (answer.outcome === "refused") return refusal(answer, asking);
  return planText(answer, map);
}

// A plan in words, whether it was just made or is under way.
export function planText(plan: PlanInWords, map: FieldMap): Child[] {
  const parts: Child[] = [];
  if (plan.read_back) parts.push(forecast(plan.read_back));
  parts.push(...words(plan.words, map), ...problems(plan));
  if (plan.read_back) parts.push(steps(plan.read_back.lines, map), ...rest(plan.read_back, plan.headings));
  parts.push(taskDocument(plan));
  return parts;
}

type PlanInWords = Omit<Planned, "outcome" | "planner"> & { planner?: string };

// What it will take, in one sentence.
function forecast({ totals: { metres: way, seconds, percent, captures, branches } }: ReadBack): HTMLElement {
  const facts = { metres: metres(way.mean), time: duration(seconds.mean), most: duration(seconds.p90), percent: number(percent.mean, percent.mean < 10 ? 1 : 0) };
  const said = `${t("forecast", facts)} ${tn("forecast_captures", captures)}`;
  return el("p", { class: "forecast" }, said, branches > 1 ? ` ${t("forecast_worst")}` : "");
}

// The request with what became of its words. Words of places, when touched, light up the map.
function words(pieces: Word[], map: FieldMap): Child[] {
  if (!pieces.length) return [];
  const shown = pieces.map((piece): Child => {
    if (!piece.name) return piece.text;
    const on = piece.nodes?.length ? map.plan.stopsOf(piece.nodes).length : 0;
    if (!on) return el("span", { class: `word ${piece.role}`, title: piece.name }, piece.text);
    const word = el("button", { type: "button", class: `word ${piece.role}`, title: `${piece.name}: ${tn("stops", on)}` }, piece.text);
    lights(word, piece.nodes, map);
    return word;
  });
  const roles = new Map(pieces.filter((piece) => piece.name).map((piece) => [piece.role, piece.name]));
  const legend = [...roles].map(([role, name]) => el("li", {}, el("span", { class: `word ${role}` }, name)));
  return [el("blockquote", { class: "said" }, shown), el("ul", { class: "word-legend", "aria-label": t("word_uses") }, legend)];
}

function lights(element: HTMLElement, nodes: string[], map: FieldMap): void {
  for (const kind of ["pointerenter", "focus"]) element.addEventListener(kind, () => map.highlight(nodes));
  for (const kind of ["pointerleave", "blur"]) element.addEventListener(kind, () => map.highlight([]));
  element.addEventListener("click", () => {
    map.highlight(nodes);
    map.reveal(nodes);
  });
}

// The choices are buttons: one plans again with the answer, and so does a tap on its place.
function question({ question: asked, choices, free, places, shown }: Clarify, map: FieldMap, { reply }: Asking): Child[] {
  const texts = shown?.choices ?? choices;
  const choice = (text: string, k: number) => {
    const marked = (places[k]?.length ?? 0) > 0;
    const button = el(
      "button",
      { type: "button", class: "choice", onclick: () => reply(asked, text) },
      el("span", { class: `badge ${marked ? choiceColour(k + 1) : "plain"}` }, String(k + 1)),
      texts[k] ?? text,
    );
    for (const kind of ["pointerenter", "focus"]) button.addEventListener(kind, () => map.plan.lightChoice(k + 1));
    for (const kind of ["pointerleave", "blur"]) button.addEventListener(kind, () => map.plan.lightChoice(0));
    return el("li", {}, button);
  };
  map.onchoice = (numbered) => choices[numbered - 1] !== undefined && reply(asked, choices[numbered - 1]!);
  const parts: Child[] = [el("p", { class: "question" }, shown?.question ?? asked), el("ol", { class: "choices" }, choices.map(choice))];
  if (places.some((one) => one.length)) parts.push(el("p", { class: "hint" }, t("or_tap")));
  if (!free) return [...parts, el("p", { class: "hint" }, t("or_write"))];
  const input = el("input", { id: "other-words", maxlength: 2000, required: true });
  const send = (event: Event) => {
    event.preventDefault();
    reply(asked, input.value);
  };
  return [
    ...parts,
    el("form", { class: "field", onsubmit: send }, el("label", { for: "other-words" }, t("other_words")), el("div", { class: "line" }, input, el("button", { type: "submit" }, t("answer")))),
  ];
}

function refusal(answer: Refused, { request, take }: Asking): Child[] {
  const spans = answer.reasons.flatMap((reason) => reason.said);
  const reasons = answer.reasons.map(({ what, advice }) => el("li", {}, sentence(what), advice ? el("span", { class: "advice" }, ` ${sentence(advice)}`) : null));
  return [
    spans.length ? el("blockquote", { class: "said" }, marked(request, spans)) : null,
    el("ul", { class: "reasons" }, reasons),
    answer.understood.length ? el("p", { class: "hint" }, `${t("understood")} ${answer.understood.join("; ")}`) : null,
    answer.example ? el("p", { class: "instead" }, t("can_be_planned"), el("button", { type: "button", class: "example", onclick: () => take(answer.example) }, answer.example)) : null,
  ];
}

// The request with the words in question marked. Ranges count characters, not the halves of surrogate pairs.
export function marked(request: string, spans: [number, number][]): Child[] {
  const characters = Array.from(request);
  const parts: Child[] = [];
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

const problems = (answer: PlanInWords): Child[] =>
  answer.problems.map(({ severity, where, what, advice }) =>
    notice(
      severity,
      where ? el("span", { class: "where" }, `${where}: `) : null,
      sentence(what),
      advice ? el("span", { class: "advice" }, ` ${sentence(advice)}`) : null,
    ),
  );

function steps(lines: ReadBackLine[], map: FieldMap): HTMLElement {
  // The way home is a line of the whole plan: its stops were named before.
  const named = new Set<string>();
  const items = lines.map((line) => {
    const nodes = [line.node, ...line.also].filter((node) => !named.has(node));
    nodes.forEach((node) => named.add(node));
    return { nodes, item: step(line, nodes, map) };
  });
  map.onstop = (nodes) => {
    for (const { nodes: own, item } of items) item.classList.toggle("lit", nodes.some((node) => own.includes(node)));
  };
  return el("ol", { class: "steps" }, items.map(({ item }) => item));
}

function step(line: ReadBackLine, nodes: string[], map: FieldMap): HTMLElement {
  const stops = map.plan.stopsOf(nodes);
  const content = [
    el("span", { class: "number" }, line.number === null ? "" : String(line.number)),
    el("span", { class: "text" }, line.text, stops.length ? badges(stops) : null),
  ];
  const indent = `indent-${Math.min(line.indent, 5)}`;
  const allNodes = [line.node, ...line.also].join(" ");
  if (!stops.length) return el("li", { class: indent, "data-nodes": allNodes }, el("div", { class: "step" }, content));
  const button = el("button", { type: "button", class: "step" }, content);
  lights(button, nodes, map);
  return el("li", { class: indent, "data-nodes": allNodes }, button);
}

function badges(stops: Stop[]): HTMLElement {
  const shown = stops.length > MANY ? [el("span", { class: "badge stop" }, tn("stops", stops.length))] : stops.map(badge);
  return el("span", { class: "badges" }, shown);
}

const badge = (stop: Stop) => el("span", { class: stop.branch ? "badge stop other" : "badge stop", title: `${t("stop")} ${stop.number}` }, String(stop.number));

function rest(back: ReadBack, headings: Record<string, string>): Child[] {
  const part = (name: string, lines: string[]): Child[] =>
    lines.length ? [el("h3", {}, name), el("ul", { class: "plain" }, lines.map((line) => el("li", {}, sentence(line))))] : [];
  const kinds = ["times", "assumptions", "notes", "limits", "faults"] as const;
  return [...kinds.flatMap((kind) => part(headings[kind] ?? "", back[kind])), totals(back.totals, headings)];
}

function totals({ metres: way, seconds, percent, captures }: ReadBack["totals"], headings: Record<string, string>): HTMLElement {
  const row = (name: string | undefined, ...cells: string[]) => el("tr", {}, el("th", { scope: "row" }, name ?? ""), cells.map((cell) => el("td", {}, cell)));
  const figures = (figure: Figure, say: (value: number) => string) => [figure.mean, figure.p50, figure.p90].map(say);
  return el(
    "details",
    { class: "more" },
    el("summary", {}, headings["totals"] ?? ""),
    el(
      "div",
      { class: "scroll", tabindex: 0, role: "group", "aria-label": headings["totals"] ?? "" },
      el(
        "table",
        {},
        el("thead", {}, el("tr", {}, el("td", {}), ["mean", "p50", "p90"].map((kind) => el("th", { scope: "col" }, headings[kind] ?? "")))),
        el(
          "tbody",
          {},
          row(headings["driving"], ...figures(way, metres)),
          row(headings["time"], ...figures(seconds, duration)),
          row(headings["battery"], ...figures(percent, (value) => `${number(value, value < 10 ? 1 : 0)} %`)),
          row(headings["captures"], String(captures), "", ""),
        ),
      ),
    ),
  );
}

const taskDocument = (answer: PlanInWords): HTMLElement =>
  el(
    "details",
    { class: "more" },
    el("summary", {}, t("task_document")),
    answer.planner ? el("p", { class: "hint" }, `${t("planned_by")} ${answer.planner}`) : null,
    el("pre", { tabindex: 0, role: "group", "aria-label": t("task_document") }, answer.xml),
    el("button", { type: "button", onclick: () => save("task.xml", "application/xml", answer.xml) }, t("download", { name: "task.xml" })),
  );
