// A failure on the page: its place before it, its advice after it.

import { Problem } from "./api";
import { el, notice, sentence } from "./dom";

export function problemNotice(problem: unknown): HTMLElement {
  const { where, what, advice } =
    problem instanceof Problem ? problem : { where: "", what: problem instanceof Error ? problem.message : String(problem), advice: "" };
  return notice(
    "error",
    where ? el("span", { class: "where" }, `${where}: `) : null,
    sentence(what),
    advice ? el("span", { class: "advice" }, ` ${sentence(advice)}`) : null,
  );
}
