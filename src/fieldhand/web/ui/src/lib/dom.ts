// Elements. Text is only ever set as text, never parsed as markup.

type Handler<E extends Event> = (event: E) => void;
type Value = string | number | boolean | null | undefined;
export type Child = Node | string | null | undefined | false;

export interface Attributes {
  [name: string]: Value | Handler<any>;
}

export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Child | Child[])[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (typeof value === "function") element.addEventListener(name.slice(2), value as EventListener);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...present(children.flat()));
  return element;
}

export function replace(parent: Element, ...children: (Child | Child[])[]): void {
  parent.replaceChildren(...present(children.flat()));
}

const present = (children: Child[]): (Node | string)[] =>
  children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false);

const SVG = "http://www.w3.org/2000/svg";

// An icon of strokes on a grid of 24 by 24.
export function icon(...paths: string[]): SVGSVGElement {
  const drawn = document.createElementNS(SVG, "svg");
  for (const [name, value] of Object.entries({ viewBox: "0 0 24 24", class: "icon", "aria-hidden": "true" })) drawn.setAttribute(name, value);
  for (const d of paths) {
    const path = document.createElementNS(SVG, "path");
    path.setAttribute("d", d);
    drawn.append(path);
  }
  return drawn;
}

export type NoticeKind = "error" | "warning" | "info";

export const notice = (kind: NoticeKind, ...children: (Child | Child[])[]): HTMLElement => el("p", { class: `notice ${kind}` }, ...children);

// A text as a sentence: with a capital letter and a full stop.
export function sentence(text: string): string {
  const trimmed = text.trim();
  return trimmed.charAt(0).toUpperCase() + trimmed.slice(1) + (/[.?!:]$/.test(trimmed) ? "" : ".");
}

// Characters that are not seen, or that turn the order of others, as \u{...}.
export const visible = (text: string): string =>
  text.replace(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}]/gu, (one) => `\\u{${one.codePointAt(0)!.toString(16)}}`);

export function save(name: string, type: string, text: string): void {
  const url = URL.createObjectURL(new Blob([text], { type }));
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

let ids = 0;

// A labelled control, with a hint below it.
export function field(label: string, control: HTMLElement, hint?: Child): HTMLElement {
  control.id ||= `field-${(ids += 1)}`;
  const below = hint ? el("p", { class: "hint", id: `${control.id}-hint` }, hint) : null;
  if (below) control.setAttribute("aria-describedby", below.id);
  return el("div", { class: "field" }, el("label", { for: control.id }, label), control, below);
}
