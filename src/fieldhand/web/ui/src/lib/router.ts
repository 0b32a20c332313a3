// Pages by the hash of the address: #/sites, #/missions/ID. A page is made when it is first opened, and kept.

import { el } from "./dom";

export interface Page {
  root: HTMLElement;
  show?(rest: string): void;
  hide?(): void;
}

export interface Route {
  name: string;
  make(): Page;
}

export class Router {
  readonly outlet = el("div", { class: "outlet", id: "content" });
  onchange: (name: string) => void = () => {};
  private readonly pages = new Map<string, Page>();
  private open: Page | null = null;

  constructor(
    private readonly routes: Route[],
    private readonly first: string,
  ) {}

  begin(): void {
    addEventListener("hashchange", () => this.follow());
    this.follow();
  }

  private follow(): void {
    const [name = "", ...rest] = location.hash.replace(/^#\/?/, "").split("/");
    const route = this.routes.find((one) => one.name === name) ?? this.routes.find((one) => one.name === this.first)!;
    let page = this.pages.get(route.name);
    if (!page) {
      page = route.make();
      this.pages.set(route.name, page);
      this.outlet.append(page.root);
    }
    if (this.open && this.open !== page) {
      this.open.hide?.();
      this.open.root.hidden = true;
    }
    const moved = this.open !== page;
    this.open = page;
    page.root.hidden = false;
    page.show?.(decodeURIComponent(rest.join("/")));
    if (moved) scrollTo(0, 0);
    this.onchange(route.name);
  }
}

export const go = (path: string): void => void location.assign(`#/${path}`);
