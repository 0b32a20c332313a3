// Ask: a request becomes a plan, a question or a refusal; an approved plan a mission.

import { current, t } from "../lang";
import { get, post } from "../lib/api";
import { canDictate, dictate, type Dictation } from "../lib/dictation";
import { el, field, icon, notice, replace, sentence } from "../lib/dom";
import { keep, kept, remember, remembered } from "../lib/kept";
import { problemNotice } from "../lib/problems";
import { go, type Page } from "../lib/router";
import { session } from "../lib/session";
import { builtIn, choiceOf, describe, own } from "../lib/sites";
import { spaced } from "../lib/figures";
import type { Answer, Given, Robot, Run, Site } from "../lib/types";
import { FieldMap, type MapView } from "../map/field_map";
import { answerTitle, renderAnswer } from "./answer";
import { legend } from "./legend";
import { missionsOffered } from "./missions";
import { Replay, replayTitle } from "./replay";

// The last answer, so that it can be read again without the server and after a restart.
interface Last {
  request: string;
  site: string;
  robot: string;
  language: string;
  answers: Given[];
  answer: Answer;
}

const ADD = "add";

export class AskPage implements Page {
  readonly root: HTMLElement;
  private readonly map = new FieldMap(t("map"));
  private readonly request = el("textarea", { id: "request", rows: 3, maxlength: 20_000, required: true, spellcheck: true, placeholder: t("placeholder") });
  private readonly site = el("select", { id: "site" });
  private readonly robot = el("select", { id: "robot" });
  private readonly planner = el("select", { id: "planner" }, ["auto", "english", "llm"].map((name) => el("option", { value: name }, t(`planner_${name}` as "planner_auto"))));
  private readonly siteHint = el("p", { class: "hint" });
  private readonly robotHint = el("p", { class: "hint" });
  private readonly examples = el("div", { class: "examples", role: "group", "aria-label": t("examples") });
  private readonly planButton = el("button", { class: "main", type: "submit" }, t("plan"));
  private readonly viewerHint = el("p", { class: "hint", hidden: true }, t("may_not_plan"));
  private readonly planNotice = el("div", { role: "alert" });
  private readonly answerTitle = el("h2", { id: "answer-title" });
  private readonly answerBody = el("div", {});
  private readonly answerCard = el("section", { class: "card answer", "aria-labelledby": "answer-title", tabindex: -1, hidden: true }, this.answerTitle, this.answerBody);
  private readonly ticks = el("div", {});
  private readonly confirm = el("fieldset", { class: "confirm", hidden: true }, el("legend", {}, t("confirm")), this.ticks);
  private readonly by = el("input", { autocomplete: "name", maxlength: 100, required: true });
  private readonly seed = el("input", { type: "number", inputmode: "numeric", min: 0, max: 4_294_967_295, step: 1, value: 0 });
  private readonly speed = el("select", {}, [["1", "1×"], ["10", "10×"], ["100", "100×"], ["max", t("speed_max")]].map(([value, words]) => el("option", { value: value!, selected: value === "10" }, words!)));
  private readonly speedField = el("div", { hidden: true }, field(t("speed"), this.speed));
  private readonly nameField = field(t("your_name"), this.by);
  private readonly runButton = el("button", { class: "main", type: "submit" }, t("approve_simulate"));
  private readonly runNotice = el("div", { role: "alert" });
  private readonly approveCard: HTMLElement;
  private readonly runTitle = el("h2", { id: "run-title" });
  private readonly runBody = el("div", {});
  private readonly runCard = el("section", { class: "card run", "aria-labelledby": "run-title", tabindex: -1, hidden: true }, this.runTitle, this.runBody);

  private robots: Robot[] = [];
  private shown: { id: string; site: Site } | null = null;
  private last: Last | null = null;
  private answers: Given[] = [];
  private replay: Replay | null = null;
  private calling: AbortController | null = null;
  private begun = false;
  private ready: Promise<void> = Promise.resolve(); // the chosen site is on the map

  constructor() {
    this.approveCard = this.approval();
    this.root = el("main", { class: "page ask" }, this.asking(), this.mapCard(), this.answerCard, this.approveCard, this.runCard);
    this.request.value = remembered("request", "");
    this.by.value = remembered("by", "");
    this.planner.value = remembered("planner", "auto");
    this.map.onview = (view) => remember(`view.${this.site.value}`, view);
  }

  show(rest: string): void {
    const wanted = rest.startsWith("site/") ? rest.slice(5) : "";
    this.ready = this.open(wanted);
  }

  hide(): void {
    this.replay?.pause();
  }

  private asking(): HTMLElement {
    this.request.addEventListener("input", () => this.changed());
    this.request.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) form.requestSubmit();
    });
    this.site.addEventListener("change", () => (this.ready = this.siteChosen()));
    this.robot.addEventListener("change", () => this.robotChosen());
    this.planner.addEventListener("change", () => remember("planner", this.planner.value));
    const form = el(
      "form",
      { onsubmit: (event: Event) => this.submit(event, () => this.plan([])) },
      el("div", { class: "request" }, this.request, this.microphone()),
      this.planButton,
      this.viewerHint,
      this.planNotice,
      this.examples,
      el(
        "div",
        { class: "fields" },
        el("div", { class: "field" }, el("label", { for: "site" }, t("site")), this.site, this.siteHint),
        el("div", { class: "field" }, el("label", { for: "robot" }, t("robot")), this.robot, this.robotHint),
      ),
      el("details", { class: "more" }, el("summary", {}, t("more")), el("div", { class: "field" }, el("label", { for: "planner" }, t("planner")), this.planner)),
    );
    return el("section", { class: "card", "aria-labelledby": "ask-title" }, el("h2", { id: "ask-title" }, el("label", { for: "request" }, t("ask_title"))), form);
  }

  private mapCard(): HTMLElement {
    return el("section", { class: "card map", "aria-label": t("map") }, this.map.root, legend());
  }

  private approval(): HTMLElement {
    return el(
      "section",
      { class: "card approve", "aria-labelledby": "approve-title", hidden: true },
      el("h2", { id: "approve-title" }, t("approve")),
      el(
        "form",
        { onsubmit: (event: Event) => this.submit(event, () => this.approve()) },
        this.confirm,
        this.nameField,
        el("details", { class: "more" }, el("summary", {}, t("simulation")), this.speedField, field(t("seed"), this.seed, t("seed_hint"))),
        this.runButton,
        this.runNotice,
      ),
    );
  }

  private microphone(): HTMLElement | null {
    if (!canDictate()) return null;
    let running: Dictation | null = null;
    const button = el("button", { type: "button", class: "microphone", "aria-label": t("dictate"), "aria-pressed": "false", title: t("dictate_hint") }, icon("M12 3a3 3 0 0 0-3 3v6a3 3 0 0 0 6 0V6a3 3 0 0 0-3-3z", "M6 11v1a6 6 0 0 0 12 0v-1M12 18v3"));
    const ended = (error: string) => {
      running = null;
      button.setAttribute("aria-pressed", "false");
      if (error && error !== "aborted" && error !== "no-speech") replace(this.planNotice, notice("warning", t("dictation_failed", { error })));
    };
    const heard = (words: string) => {
      if (!words) return;
      const before = this.request.value.trimEnd();
      this.request.value = before ? `${before} ${words}` : words.charAt(0).toUpperCase() + words.slice(1);
      this.changed();
    };
    button.addEventListener("click", async () => {
      if (running) return running.stop();
      button.setAttribute("aria-pressed", "true");
      running = await dictate(current(), heard, ended).catch(() => null);
      if (!running) ended("");
    });
    return button;
  }

  // Fills the lists, shows the site, and what was planned last.
  private async open(wanted: string): Promise<void> {
    const before = this.site.value || remembered("site", "demo");
    // Who has an account approves under its name.
    if (!session.local) this.by.value = session.name;
    this.nameField.hidden = !session.local;
    this.planButton.disabled = !session.may("plan");
    this.viewerHint.hidden = session.may("plan");
    void missionsOffered().then((offered) => (this.speedField.hidden = !offered));
    try {
      await this.listSites(wanted || before);
      if (wanted) {
        if (wanted !== before) this.outdate();
        remember("site", wanted);
        history.replaceState(null, "", "#/ask");
      }
      if (!this.begun) await this.listRobots();
      await this.showSite();
      if (!this.begun) await this.restore();
      this.begun = true;
      void this.listExamples();
    } catch (problem) {
      replace(this.planNotice, problemNotice(problem));
    }
  }

  private async listSites(chosen: string): Promise<void> {
    const sites = [...(await builtIn()).map(({ name, title }) => [name, title]), ...(await own()).map(({ id, title }) => [id, title])];
    replace(this.site, ...sites.map(([id, title]) => el("option", { value: id!, selected: id === chosen }, title!)), el("option", { value: ADD }, t("add_site")));
  }

  private async listRobots(): Promise<void> {
    this.robots = await get<Robot[]>("/robots").catch(async (problem) => {
      const before = await kept<Robot[]>("robots");
      if (before) return before;
      throw problem;
    });
    void keep("robots", this.robots);
    const chosen = remembered("robot", "husky");
    replace(this.robot, ...this.robots.map(({ name }) => el("option", { value: name, selected: name === chosen }, name)));
    this.sayRobot();
  }

  private sayRobot(): void {
    const robot = this.robots.find(({ name }) => name === this.robot.value);
    this.robotHint.textContent = robot ? robot.actions.map(spaced).join(", ") : "";
  }

  private robotChosen(): void {
    remember("robot", this.robot.value);
    this.sayRobot();
    this.outdate();
    void this.listExamples();
  }

  private async siteChosen(): Promise<void> {
    if (this.site.value === ADD) {
      this.site.value = this.shown?.id ?? "demo";
      go("sites");
      return;
    }
    remember("site", this.site.value);
    this.outdate();
    await this.showSite().catch((problem) => replace(this.planNotice, problemNotice(problem)));
    void this.listExamples();
  }

  private async showSite(): Promise<void> {
    const id = this.site.value;
    if (this.shown?.id === id) return;
    this.map.clear();
    this.siteHint.textContent = "";
    const site = await describe(id);
    if (!site || this.site.value !== id) return;
    this.shown = { id, site };
    this.map.showSite(site.map.features, remembered<MapView | null>(`view.${id}`, null));
    const known = site.attributes.filter((one) => !/^(id|kind|type|row|block|marker-.*)$/.test(one)).map(spaced);
    this.siteHint.textContent = [t("plants", { count: site.trees }), ...known].join(", ");
    replace(this.planNotice, ...site.notes.map((text) => notice("warning", sentence(text))));
  }

  // Requests that can be planned on this site with this robot.
  private async listExamples(): Promise<void> {
    const [id, robot] = [this.site.value, this.robot.value];
    const name = `examples.${id}.${robot}.${current()}`;
    let texts = await kept<string[]>(name);
    if (!texts) {
      const site = await choiceOf(id);
      const found = await post<{ examples: string[] }>("/examples", { site, robot, lang: current() }).catch(() => null);
      texts = found?.examples ?? [];
      if (found) void keep(name, texts);
    }
    if (this.site.value !== id || this.robot.value !== robot) return;
    replace(this.examples, ...texts.map((text) => el("button", { type: "button", class: "example", onclick: () => this.take(text) }, text)));
  }

  private async restore(): Promise<void> {
    const last = await kept<Last>("ask.last");
    if (!last || last.request !== this.request.value || last.site !== this.site.value || last.robot !== this.robot.value || last.language !== current()) return;
    this.answers = last.answers;
    this.showAnswer(last, false);
  }

  private take(text: string): void {
    this.request.value = text;
    this.changed();
    this.request.focus();
  }

  private changed(): void {
    remember("request", this.request.value);
    this.outdate();
  }

  private submit(event: Event, action: () => unknown): void {
    event.preventDefault();
    void action();
  }

  // What is below belongs to other words: it goes, so that nothing else than what is read is approved.
  private outdate(): void {
    this.calling?.abort();
    this.answers = [];
    this.last = null;
    this.replay?.pause();
    this.map.clearPlan();
    for (const card of [this.answerCard, this.approveCard, this.runCard]) card.hidden = true;
    replace(this.planNotice);
    replace(this.runNotice);
    document.documentElement.classList.remove("answered");
  }

  private async plan(answers: Given[]): Promise<void> {
    this.outdate();
    await this.during(this.planButton, this.planNotice, async (signal) => {
      await this.ready; // before it, no robot is chosen
      const [request, id, robot, language] = [this.request.value, this.site.value, this.robot.value, current()];
      const site = await choiceOf(id);
      const answer = await post<Answer>("/plan", { request, site, robot, planner: this.planner.value, lang: language, answers }, signal);
      // Words that were changed meanwhile have another plan.
      if (this.request.value !== request || this.site.value !== id || this.robot.value !== robot) return;
      this.answers = answers;
      const last: Last = { request, site: id, robot, language, answers, answer };
      void keep("ask.last", last);
      this.showAnswer(last, true);
    });
  }

  private showAnswer(last: Last, scroll: boolean): void {
    this.last = last;
    const { answer } = last;
    this.map.onchoice = () => {};
    if (answer.outcome === "planned") this.map.showPlan(answer.map.features);
    if (answer.outcome === "clarify") this.map.showChoices(answer.map.features);
    const asking = {
      request: last.request,
      reply: (question: string, given: string) => void this.plan([...this.answers, { question, answer: given }]),
      take: (text: string) => this.take(text),
    };
    this.answerTitle.textContent = answerTitle(answer);
    replace(this.answerBody, renderAnswer(answer, this.map, asking));
    this.answerCard.hidden = false;
    const warnings = answer.outcome === "planned" ? answer.warnings : [];
    this.approveCard.hidden = !(answer.outcome === "planned" && answer.approvable && session.may("approve"));
    replace(this.ticks, ...warnings.map((text) => el("label", { class: "tick" }, el("input", { type: "checkbox", required: true, value: text }), el("span", {}, sentence(text)))));
    this.confirm.hidden = !warnings.length;
    document.documentElement.classList.add("answered");
    if (scroll) reveal(this.answerCard);
  }

  private async approve(): Promise<void> {
    if (this.last?.answer.outcome !== "planned") return;
    const { site: id, robot, answer } = this.last;
    const by = this.by.value.trim();
    if (session.local) remember("by", by);
    const confirmed = [...this.ticks.querySelectorAll<HTMLInputElement>("input:checked")].map((box) => box.value);
    const seed = Number(this.seed.value || 0);
    await this.during(this.runButton, this.runNotice, async (signal) => {
      const mission = { approved_by: by, xml: answer.xml, site: await choiceOf(id), robot, lang: answer.language, confirmed, seed };
      const speed = this.speed.value === "max" ? "max" : Number(this.speed.value);
      if (await missionsOffered()) await this.start({ ...mission, speed }, signal);
      else await this.simulate(mission, signal);
    });
  }

  private async start(mission: object, signal: AbortSignal): Promise<void> {
    const { id } = await post<{ id: string }>("/missions", mission, signal);
    go(`missions/${encodeURIComponent(id)}`);
  }

  private async simulate(body: object, signal: AbortSignal): Promise<void> {
    this.replay?.pause();
    const run = await post<Run>("/run", body, signal);
    this.replay = new Replay(run, this.map);
    this.runTitle.textContent = replayTitle(run);
    replace(this.runBody, this.replay.root);
    this.runCard.className = `card run ${run.success ? "success" : "failure"}`;
    this.runCard.hidden = false;
    this.replay.seek(0);
    reveal(this.runCard);
    this.replay.play();
  }

  // One call at a time: a new one ends the one before.
  private async during(button: HTMLButtonElement, place: HTMLElement, action: (signal: AbortSignal) => Promise<void>): Promise<void> {
    this.calling?.abort();
    const mine = (this.calling = new AbortController());
    replace(place);
    button.disabled = true;
    button.setAttribute("aria-busy", "true");
    try {
      await action(mine.signal);
    } catch (problem) {
      if (!(problem instanceof DOMException && problem.name === "AbortError")) replace(place, problemNotice(problem));
    } finally {
      if (this.calling === mine) this.calling = null;
      button.disabled = false;
      button.removeAttribute("aria-busy");
    }
  }
}

function reveal(card: HTMLElement): void {
  card.focus({ preventScroll: true });
  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  card.scrollIntoView({ block: matchMedia("(min-width: 900px)").matches ? "nearest" : "start", behavior: calm ? "auto" : "smooth" });
}
