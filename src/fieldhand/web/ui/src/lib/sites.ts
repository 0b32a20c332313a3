// The sites to choose from: the server's own, and those that were added on this device.

import { get, post } from "./api";
import { forget, keep, kept } from "./kept";
import type { Site, SiteChoice, SiteName } from "./types";

export interface OwnSite {
  id: string; // "own-…"
  title: string;
  trees: number;
  file: string;
  choice: SiteChoice;
}

const MAX_BYTES = 11_000_000; // a body has at most 16 MB, and base64 takes a third more
const TEXTS = /\.(geojson|json|csv|tsv|txt|kml)$/i;

export const ENDINGS = ".geojson,.json,.csv,.tsv,.txt,.kml,.kmz,.gpkg,.zip";

export async function builtIn(): Promise<SiteName[]> {
  try {
    const sites = await get<SiteName[]>("/sites");
    void keep("sites.server", sites);
    return sites;
  } catch (problem) {
    const before = await kept<SiteName[]>("sites.server");
    if (before) return before;
    throw problem;
  }
}

export const own = async (): Promise<OwnSite[]> => (await kept<OwnSite[]>("sites.own")) ?? [];

// What is sent to the server for a site of the list.
export async function choiceOf(id: string): Promise<SiteChoice | null> {
  if (!id.startsWith("own-")) return id;
  return (await own()).find((site) => site.id === id)?.choice ?? null;
}

// The description of a site: asked of the server, else as it was last time.
export async function describe(id: string, signal?: AbortSignal): Promise<Site | null> {
  const choice = await choiceOf(id);
  if (choice === null) return null;
  try {
    const site = await post<Site>("/site", { site: choice }, signal);
    void keep(`site.${id}`, site);
    return site;
  } catch (problem) {
    if (problem instanceof DOMException) throw problem;
    const before = await kept<Site>(`site.${id}`);
    if (before && (problem as { status?: number }).status === 0) return before;
    throw problem;
  }
}

export class TooLarge extends Error {}

// Adds the site in a file, as the server reads it.
export async function add(file: File): Promise<OwnSite> {
  if (file.size > MAX_BYTES) throw new TooLarge();
  const name = file.name.slice(-100);
  const choice: SiteChoice = TEXTS.test(name) ? { name, text: await file.text() } : { name, base64: base64(await file.arrayBuffer()) };
  const site = await post<Site>("/site", { site: choice });
  const id = `own-${site.sha256.slice(0, 16)}`;
  const added = { id, title: site.name, trees: site.trees, file: name, choice };
  await keep(`site.${id}`, site);
  await keep("sites.own", [...(await own()).filter((one) => one.id !== id), added]);
  return added;
}

export async function drop(id: string): Promise<void> {
  await keep("sites.own", (await own()).filter((one) => one.id !== id));
  await forget(`site.${id}`);
}

function base64(buffer: ArrayBuffer): string {
  const bytes = new Uint8Array(buffer);
  let text = "";
  for (let k = 0; k < bytes.length; k += 0x8000) text += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
  return btoa(text);
}
