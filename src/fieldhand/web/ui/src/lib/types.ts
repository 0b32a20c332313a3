// The bodies of the REST API, as far as the page reads them (docs/api.md).

export type Position = [number, number]; // longitude, latitude

export interface Feature {
  type: "Feature";
  geometry:
    | { type: "Point"; coordinates: Position }
    | { type: "LineString"; coordinates: Position[] }
    | { type: "Polygon"; coordinates: Position[][] };
  properties: Record<string, any> & { role: string };
}

export interface FeatureCollection {
  type: "FeatureCollection";
  features: Feature[];
}

export type SiteChoice = string | { name: string; text: string } | { name: string; base64: string };

export interface SiteName {
  name: string;
  title: string;
  trees: number;
}

export interface Site {
  name: string;
  sha256: string;
  trees: number;
  markers: string[];
  zones: { name: string; kind: string }[];
  attributes: string[];
  notes: string[];
  map: FeatureCollection;
}

export interface Robot {
  name: string;
  description: string;
  actions: string[];
}

export interface Given {
  question: string;
  answer: string;
}

export interface Figure {
  mean: number;
  p50: number;
  p90: number;
}

export interface ReadBackLine {
  number: number | null;
  node: string;
  also: string[];
  indent: number;
  text: string;
}

export interface ReadBack {
  lines: ReadBackLine[];
  times: string[];
  assumptions: string[];
  notes: string[];
  limits: string[];
  faults: string[];
  totals: { metres: Figure; seconds: Figure; percent: Figure; captures: number; branches: number };
}

export interface Word {
  text: string;
  role: string;
  name: string;
  nodes: string[];
}

export interface Planned {
  outcome: "planned";
  planner: string;
  xml: string;
  task: string;
  words: Word[];
  approvable: boolean;
  warnings: string[];
  problems: { severity: "error" | "warning"; where: string; what: string; advice: string }[];
  read_back: ReadBack | null;
  language: string;
  headings: Record<string, string>;
  map: FeatureCollection;
}

export interface Clarify {
  outcome: "clarify";
  question: string;
  choices: string[];
  free: boolean;
  places: string[][];
  map: FeatureCollection;
  shown?: { question: string; choices: string[] };
}

export interface Refused {
  outcome: "refused";
  reasons: { what: string; advice: string; said: [number, number][] }[];
  understood: string[];
  example: string;
}

export type Answer = Planned | Clarify | Refused;

export interface LogEvent {
  event: string;
  t: number;
  [key: string]: unknown;
}

export interface Goal {
  name: string;
  node: string;
  outcome: "success" | "failure" | "indeterminate";
  why: string;
}

export interface Run {
  outcome: "ran";
  authorization: { by: string; at: string };
  status: string;
  reason: string;
  success: boolean;
  travelled_m: number;
  seconds: number;
  charge_percent: number;
  goals: Goal[];
  events: LogEvent[];
  told: string[];
  map: FeatureCollection;
}

// The state of a live mission.
export interface MissionState {
  id: string;
  state: "starting" | "running" | "paused" | "interrupted" | "ended";
  status: string;
  reason: string;
  request: string;
  site: string;
  robot: string;
  by: string;
  begun_at: string;
  speed: number | "max";
  doing: string;
  near: string;
  node: string;
  lat: number | null;
  lon: number | null;
  seconds: number | null;
  travelled_m: number | null;
  charge_percent: number | null;
  captures: number;
  goals: Goal[];
  report: boolean;
  fault: string;
}

export type Mission = MissionState & Omit<Planned, "outcome" | "planner">;

export interface MissionEvent {
  mission: string;
  n: number;
  at: string;
  event: LogEvent;
  told: string;
}

export interface RobotPosition {
  mission: string;
  t: number;
  lat: number;
  lon: number;
  heading_deg: number | null;
  charge_percent: number | null;
}

export type Heard =
  | { kind: "mission"; data: MissionState }
  | { kind: "event"; data: MissionEvent }
  | { kind: "position"; data: RobotPosition }
  | { kind: "gone"; data: { mission: string; why: string } }
  | { kind: "heartbeat"; data: { at: string } };
