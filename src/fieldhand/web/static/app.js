// The page: a request becomes a plan, an approved plan a simulated mission.

import { render as renderAnswer, ticks, title as answerTitle } from "./answer.js";
import { get, post } from "./api.js";
import { $, el, notice, problemNotice, sentence } from "./dom.js";
import { Flight, title as flightTitle } from "./flight.js";
import { FieldMap } from "./map.js";

const EXAMPLES = [
  "Take a thermal picture at the four corner trees, in any order.",
  "Measure CO2 at the middle tree. If it is low, take 2 pictures of nearby trees.",
  "Take pictures of as many Nonpareil trees in the northern half as you can without driving more than 700 meters.",
  "Take pictures of the 5 oldest trees.",
];
const LEGEND = [
  ["stop", "Stop"],
  ["path", "Planned"],
  ["path other", "On some branches"],
  ["driven", "Driven"],
  ["keep_out", "Keep out"],
];
const MAX_FILE = 15_000_000;

const map = new FieldMap();
let robots = [];
let uploaded = null; // {name, text} of the user's own site
let plan = null; // {answer, site, robot}: what approval is about
let answers = []; // to the questions that were asked about this request
let flight = null;
let calling = null;

const chosenSite = () => ($("site").value === "file" ? uploaded : $("site").value);

async function begin() {
  $("examples").append(...EXAMPLES.map((text) => el("button", { type: "button", class: "example", onclick: () => take(text) }, text)));
  $("legend").append(...LEGEND.map(([kind, words]) => el("li", {}, el("span", { class: `key ${kind}` }), words)));
  $("by").value = localStorage.getItem("fieldhand.by") ?? "";
  $("plan-form").addEventListener("submit", (event) => submit(event, () => ((answers = []), planRequest())));
  $("approve-form").addEventListener("submit", (event) => submit(event, simulate));
  $("request").addEventListener("keydown", (event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) $("plan-form").requestSubmit();
  });
  $("robot").addEventListener("change", () => (showRobot(), outdate()));
  $("site").addEventListener("change", () => (outdate(), showSite()));
  $("language").addEventListener("change", () => (localStorage.setItem("fieldhand.language", $("language").value), outdate()));
  $("file").addEventListener("change", readFile);
  $("request").addEventListener("input", outdate);
  try {
    robots = await get("/api/robots");
    $("robot").append(...robots.map((robot) => el("option", { value: robot.name, selected: robot.name === "husky" }, robot.name)));
    showRobot();
    const spoken = await get("/api/languages");
    const wanted = localStorage.getItem("fieldhand.language") ?? navigator.language.slice(0, 2);
    $("language").append(...spoken.map(({ code, name }) => el("option", { value: code, lang: code, selected: code === wanted }, name)));
    await showSite();
  } catch (problem) {
    $("plan-notice").replaceChildren(problemNotice(problem));
  }
}

function take(text) {
  $("request").value = text;
  outdate();
  $("request").focus();
}

function submit(event, action) {
  event.preventDefault();
  action();
}

function showRobot() {
  const robot = robots.find((one) => one.name === $("robot").value);
  $("robot-hint").textContent = robot ? robot.actions.map((name) => name.replaceAll("_", " ")).join(", ") : "";
}

async function readFile() {
  const file = $("file").files[0];
  uploaded = null;
  if (file && file.size > MAX_FILE) {
    $("plan-notice").replaceChildren(notice("error", "This file is too large: 15 MB at most."));
    return;
  }
  if (file) uploaded = { name: file.name.slice(-100), text: await file.text() };
  outdate();
  await showSite();
}

async function showSite() {
  $("file-field").hidden = $("site").value !== "file";
  $("site-hint").textContent = "";
  map.clear();
  const site = chosenSite();
  if (!site) return;
  await during($("plan-button"), $("plan-notice"), async (signal) => {
    const known = await post("/api/site", { site }, signal).catch((problem) => {
      if (typeof site !== "string") uploaded = null;
      throw problem;
    });
    map.showSite(known.map.features);
    $("site-hint").textContent = siteWords(known);
    $("plan-notice").replaceChildren(...known.notes.map((text) => notice("warning", sentence(text))));
  });
}

// A site in a line; what a file needs for itself (ids, symbols) says nothing to its reader.
function siteWords({ name, trees, attributes }) {
  const known = attributes.filter((one) => !/^(id|kind|type|marker-.*)$/.test(one));
  return `${name}: ${trees} tree${trees === 1 ? "" : "s"}${known.length ? `; known: ${known.join(", ").replaceAll("_", " ")}` : ""}`;
}

// What stands below belongs to other words: it goes, so that nothing else than what is read is approved.
function outdate() {
  answers = [];
  plan = null;
  flight?.pause();
  map.clearPlan();
  for (const id of ["answer", "approve", "flight"]) $(id).hidden = true;
}

async function planRequest() {
  const [request, site, robot] = [$("request").value, chosenSite(), $("robot").value];
  if (!site) {
    $("plan-notice").replaceChildren(notice("error", "Choose the GeoJSON file of your site first."));
    return;
  }
  const given = answers;
  outdate();
  answers = given;
  await during($("plan-button"), $("plan-notice"), async (signal) => {
    const body = { request, site, robot, planner: $("planner").value, lang: $("language").value || "en", answers };
    const answer = await post("/api/plan", body, signal);
    // Words that were changed meanwhile have another plan.
    if ($("request").value !== request || chosenSite() !== site || $("robot").value !== robot) return;
    if (answer.outcome === "planned") {
      plan = { answer, site, robot };
      map.showPlan(answer.map.features);
    }
    if (answer.outcome === "clarify") map.showChoices(answer.map.features, answer.choices, (choice) => reply(answer.question, choice));
    showAnswer(answer, request);
  });
}

function showAnswer(answer, request) {
  $("answer-title").textContent = answerTitle(answer);
  $("answer-body").replaceChildren(...renderAnswer(answer, request, map, reply));
  $("answer").hidden = false;
  $("approve").hidden = !(answer.outcome === "planned" && answer.approvable);
  $("ticks").replaceChildren(...ticks(answer.warnings ?? []));
  $("confirm").hidden = !answer.warnings?.length;
  $("answer").focus({ preventScroll: true });
  $("answer").scrollIntoView({ block: "nearest", behavior: "smooth" });
}

function reply(question, answer) {
  answers = [...answers, { question, answer }];
  planRequest();
}

async function simulate() {
  if (!plan) return;
  const { answer, site, robot } = plan;
  const by = $("by").value.trim();
  localStorage.setItem("fieldhand.by", by);
  flight?.pause();
  const confirmed = [...$("ticks").querySelectorAll("input:checked")].map((box) => box.value);
  const lang = answer.language;
  const body = { xml: answer.xml, site, robot, lang, approved_by: by, confirmed, seed: Number($("seed").value || 0) };
  await during($("run-button"), $("run-notice"), async (signal) => {
    const run = await post("/api/run", body, signal);
    flight = new Flight(run, map);
    $("flight-title").textContent = flightTitle(run);
    $("flight-body").replaceChildren(...flight.render());
    $("flight").className = `card flight ${run.success ? "success" : "failure"}`;
    $("flight").hidden = false;
    flight.seek(0);
    $("flight").focus({ preventScroll: true });
    $("flight").scrollIntoView({ block: "nearest", behavior: "smooth" });
    flight.play();
  });
}

// One call at a time: a new one ends the one before.
async function during(button, place, action) {
  calling?.abort();
  const mine = (calling = new AbortController());
  place.replaceChildren();
  button.disabled = true;
  button.setAttribute("aria-busy", "true");
  try {
    await action(mine.signal);
  } catch (problem) {
    if (problem.name !== "AbortError") place.replaceChildren(problemNotice(problem));
  } finally {
    if (calling === mine) calling = null;
    button.disabled = false;
    button.removeAttribute("aria-busy");
  }
}

begin();
