// Sites: the server's, and files of one's own; what was understood of their rows.

import { t, tn } from "../lang";
import { el, field, notice, replace, sentence, visible, type Child } from "../lib/dom";
import { number, spaced } from "../lib/figures";
import { problemNotice } from "../lib/problems";
import { go, type Page } from "../lib/router";
import { add, builtIn, describe, drop, ENDINGS, own, TooLarge } from "../lib/sites";
import type { Feature, Site } from "../lib/types";
import { FieldMap } from "../map/field_map";
import { legend } from "./legend";

const MOST_VALUES = 6;

export class SitesPage implements Page {
  readonly root: HTMLElement;
  private readonly map = new FieldMap(t("map"));
  private readonly list = el("ul", { class: "list" });
  private readonly place = el("div", { role: "alert" });
  private readonly title = el("h2", { id: "site-title" });
  private readonly body = el("div", {});
  private readonly card = el("section", { class: "card", "aria-labelledby": "site-title", tabindex: -1, hidden: true }, this.title, this.body);
  private open = "";

  constructor() {
    const file = el("input", { type: "file", accept: ENDINGS });
    file.addEventListener("change", () => file.files?.[0] && void this.add(file.files[0]).then(() => (file.value = "")));
    this.root = el(
      "main",
      { class: "page sites" },
      el("section", { class: "card", "aria-labelledby": "sites-title" }, el("h2", { id: "sites-title" }, t("sites")), this.list, field(t("add_site_file"), file, t("add_site_hint")), this.place),
      el("section", { class: "card map", "aria-label": t("map") }, this.map.root, legend()),
      this.card,
    );
  }

  show(rest: string): void {
    void this.refresh(rest);
  }

  private async refresh(wanted = ""): Promise<void> {
    try {
      const sites = [...(await builtIn()).map(({ name, title, trees }) => ({ id: name, title, trees, file: "" })), ...(await own())];
      this.open = wanted || this.open || sites[0]?.id || "";
      replace(
        this.list,
        ...sites.map(({ id, title, trees, file }) =>
          el("li", {}, el("button", { type: "button", class: "row", "aria-current": id === this.open ? "true" : false, onclick: () => go(`sites/${encodeURIComponent(id)}`) }, el("strong", {}, title), el("span", { class: "hint" }, [t("plants", { count: number(trees) }), visible(file)].filter(Boolean).join(", ")))),
        ),
      );
      const site = await describe(this.open);
      if (site) this.describe(this.open, site);
    } catch (problem) {
      replace(this.place, problemNotice(problem));
    }
  }

  private async add(file: File): Promise<void> {
    replace(this.place, notice("info", t("reading_file", { name: visible(file.name) })));
    try {
      const { id } = await add(file);
      replace(this.place);
      go(`sites/${encodeURIComponent(id)}`);
      await this.refresh(id);
      this.card.focus({ preventScroll: true });
    } catch (problem) {
      replace(this.place, problem instanceof TooLarge ? notice("error", t("file_too_large")) : problemNotice(problem));
    }
  }

  private describe(id: string, site: Site): void {
    this.map.showSite(site.map.features);
    this.title.textContent = site.name;
    const removing = el("button", { type: "button", onclick: () => void drop(id).then(() => ((this.open = ""), go("sites"), this.refresh())) }, t("remove_site"));
    replace(
      this.body,
      el("div", { class: "buttons" }, el("button", { type: "button", class: "main", onclick: () => go(`ask/site/${encodeURIComponent(id)}`) }, t("use_site")), id.startsWith("own-") ? removing : null),
      site.notes.map((text) => notice("warning", sentence(text))),
      rowsUnderstood(site.map.features),
      attributes(site),
      places(site),
    );
    this.card.hidden = false;
  }
}

// Blocks and rows: how many, and which were inferred from the plants.
function rowsUnderstood(features: Feature[]): Child[] {
  const rows = features.filter((f) => f.properties.role === "row").map((f) => f.properties);
  const loose = features.filter((f) => f.properties.role === "tree" && !f.properties["row"]).length;
  const blocks = new Map<string, typeof rows>();
  for (const row of rows) blocks.set(row["block"], [...(blocks.get(row["block"]) ?? []), row]);
  const line = ([name, own]: [string, typeof rows]) => {
    const inferred = own.filter((row) => row["known"] === "inferred");
    const least = inferred.reduce((low, row) => Math.min(low, row["confidence"]), 1);
    const source = inferred.length ? t("rows_inferred", { count: inferred.length, percent: number(100 * least) }) : t("rows_from_file");
    return el("tr", {}, el("th", { scope: "row" }, name), el("td", {}, number(own.length)), el("td", {}, source));
  };
  return [
    el("h3", {}, t("rows_title")),
    rows.length
      ? el("table", {}, el("thead", {}, el("tr", {}, [t("block"), t("rows"), t("rows_source")].map((head) => el("th", { scope: "col" }, head)))), el("tbody", {}, [...blocks].map(line)))
      : el("p", {}, t("no_rows")),
    loose ? el("p", { class: "hint" }, tn("loose_plants", loose)) : null,
  ];
}

// What is known of each plant, with some of the values.
function attributes(site: Site): Child[] {
  const trees = site.map.features.filter((f) => f.properties.role === "tree");
  const line = (name: string) => {
    const values = trees.map((tree) => tree.properties["attributes"][name]).filter((value) => value !== undefined);
    const numbers = values.filter((value): value is number => typeof value === "number");
    const texts = [...new Set(values.map(String))].sort();
    const shown =
      numbers.length === values.length && numbers.length
        ? `${number(numbers.reduce((a, b) => Math.min(a, b)), 2)} – ${number(numbers.reduce((a, b) => Math.max(a, b)), 2)}`
        : [...texts.slice(0, MOST_VALUES), ...(texts.length > MOST_VALUES ? ["…"] : [])].join(", ");
    return el("tr", {}, el("th", { scope: "row" }, spaced(name)), el("td", {}, shown));
  };
  const names = site.attributes.filter((name) => !/^(id|kind|type|row|block|marker-.*)$/.test(name));
  return names.length ? [el("h3", {}, t("attributes_title")), el("table", {}, el("tbody", {}, names.map(line)))] : [];
}

function places(site: Site): Child[] {
  const names = [...site.markers, ...site.zones.map(({ name, kind }) => name || spaced(kind))];
  return names.length ? [el("h3", {}, t("places_title")), el("p", {}, names.join(", "))] : [];
}
