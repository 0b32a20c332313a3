// The signs of the map.

import { t, type Key } from "../lang";
import { el } from "../lib/dom";

const SIGNS: [string, Key][] = [
  ["stop", "stop"],
  ["path", "planned_drive"],
  ["path other", "on_some_branches"],
  ["driven", "driven"],
  ["keep_out", "keep_out"],
];

export const legend = (): HTMLElement => el("ul", { class: "legend", "aria-label": t("legend") }, SIGNS.map(([kind, words]) => el("li", {}, el("span", { class: `key ${kind}` }), t(words))));
