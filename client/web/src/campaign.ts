import { get, url } from './api/client';
import type { Campaign, Constraint } from './api/types';
import { inputUnit, inputWords, shownUnit } from './inputs';
import { FIGURES, figureWords } from './figures';
import { rounded } from './format';
import { kelvin, plain, shown, type Unit } from './units';

/** What a column is to the reader: chosen by whoever made the campaign, or computed. */
export type ColumnKind = 'candidate' | 'condition' | 'figure';

/** A column of the rows that are shown. */
export interface Column {
  name: string; // of the service
  label: string;
  unit: Unit;
  kind: ColumnKind;
  values: (number | null)[]; // one for each row
}

/** Rows of a campaign: candidates at conditions. */
export interface Rows {
  candidates: number[]; // counted from 0
  conditions: number[];
  refusals: number[]; // 0: the row has figures; -1: not computed yet
  isWithheld: boolean[]; // a warning of the row withholds the verdict
  columns: Column[];
  texts: { name: string; values: string[] }[]; // attributes in words, one for each candidate
  isCut: boolean; // the campaign has more rows
}

/** The answer of ReadCampaign as columns. */
interface Table {
  units: Record<string, string>;
  columns: Record<string, (number | null)[]>;
}

export const MOST_ROWS = 12_000;
export const MOST_CANDIDATES = 5_000; // with their parameters: some 3 MB

/** Columns about the computation itself. */
const ABOUT = ['refusal_number', 'settled', 'period_in_mesh_cycles', 'model', 'candidate', 'condition', 'verdict_withheld', 'warning_bits'];

const ELASTICITY = 'elasticity.'; // then the figure, '.' and the parameter

/** Figures that are temperatures and not differences of temperatures. */
const TEMPERATURES = ['contact_temperature_maximum_kelvin', 'contact_temperature_mean_kelvin', 'contact_temperature_kelvin'];

/** The unit in which a column is shown: by the schema, of figures by the table. */
function unitOf(name: string, kind: ColumnKind, table: Table, constraints: Constraint[]): Unit {
  if (kind !== 'figure') return inputUnit(name, constraints);
  if (name.startsWith(ELASTICITY)) return plain('');
  return TEMPERATURES.includes(name) ? kelvin : shownUnit(table.units[name] ?? '');
}

const CONDITIONS: Record<string, string> = {
  speed_kilometres_per_hour: 'Speed', sump_temperature_celsius: 'Sump', ascent_angle_degrees: 'Ascent',
  inlet_temperature_rise_kelvin: 'Rise to the inlet',
};

/** Conditions of a rig; the server computes loads from mean pressures. */
const RIG_CONDITIONS: Record<string, string> = {
  load_newtons: 'Load', entrainment_speed_metres_per_second: 'Entrainment speed', slide_roll_ratio_percent: 'Slide-roll ratio',
  supply_temperature_celsius: 'Oil',
};

/** The figure by which candidates are ranked if nothing else is chosen. */
export const usualFigure = (campaign: Campaign): string => (campaign.rig ? 'traction_coefficient' : 'inefficiency_energy_mean_percent');

/** The number of conditions of a campaign, of the axle or of a rig. */
export const conditionsOf = (campaign: Campaign): number => (campaign.points ?? 0) / (campaign.candidates ?? 1);

/** The conditions of a rig in words, in their order. */
export function rigConditions(campaign: Campaign, rows: Rows): string[] {
  const columns = rows.columns.filter((each) => RIG_CONDITIONS[each.name]);
  return Array.from({ length: conditionsOf(campaign) }, (_, k) =>
    columns.map(({ unit, values }) => (values[k] == null ? '' : `${rounded(shown(values[k]!, unit))} ${unit.symbol}`)).join(', '));
}

function labelOf(name: string, kind: ColumnKind): string {
  const condition = CONDITIONS[name] ?? RIG_CONDITIONS[name];
  if (condition) return condition;
  if (name.startsWith(ELASTICITY)) {
    const [, figure, ...parameter] = name.split('.');
    return `${figureWords(figure!)} by ${inputWords(parameter.join('.')).toLowerCase()}, elasticity`;
  }
  if (kind === 'figure') return figureWords(name);
  if (/^(lubricant|surface)\./.test(name)) return inputWords(name);
  const words = name.replaceAll('_', ' ');
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** Reads the rows of a campaign that are shown: its first ones, finished or not. */
export async function readRows(campaign: Campaign, constraints: Constraint[], signal: AbortSignal): Promise<Rows> {
  const factors = (campaign.candidate_columns ?? []).map((each) => each.path!);
  const attributes = (campaign.candidate_attributes ?? []).filter((each) => (each.texts ?? []).length === 0).map((each) => each.name!);
  const states = campaign.rig ? Object.keys(RIG_CONDITIONS) : Object.keys(CONDITIONS).filter((name) => new Set((campaign.conditions ?? []).map((each) => each[name as keyof typeof each])).size > 1);
  const read = (columns: string[]) => get<Table>(url(`${campaign.name}:read`, { alt: 'columns', columns, row_count: MOST_ROWS }), signal);
  const [figures, inputs] = await Promise.all([read([]), read(['candidate', 'condition', ...states, ...factors, ...attributes])]);
  const columnsOf = (table: Table, names: string[], kind: ColumnKind): Column[] =>
    names.map((name) => ({ name, kind, label: labelOf(name, kind), unit: unitOf(name, kind, table, constraints), values: table.columns[name] ?? [] }));
  return {
    candidates: inputs.columns['candidate'] as number[],
    conditions: inputs.columns['condition'] as number[],
    refusals: figures.columns['refusal_number'] as number[],
    isWithheld: (figures.columns['verdict_withheld'] ?? []).map((each) => each === 1),
    columns: [
      ...columnsOf(inputs, [...factors, ...attributes], 'candidate'),
      ...columnsOf(inputs, states, 'condition'),
      ...columnsOf(figures, [...Object.keys(FIGURES), ...Object.keys(figures.columns).filter((name) => !FIGURES[name])].filter((name) => figures.columns[name] && !ABOUT.includes(name)), 'figure'),
    ],
    texts: (campaign.candidate_attributes ?? []).filter((each) => (each.texts ?? []).length > 0).map((each) => ({ name: each.name!, values: each.texts! })),
    isCut: (campaign.points ?? 0) > MOST_ROWS,
  };
}

/** A range of a column to which rows are restricted, in the unit of the service. */
export interface Range {
  column: string;
  low: number;
  high: number;
}

/** Ranges of an address: "mesh_loss_power_watts:20..30,cost:..5". */
export const rangesOf = (text: string | null): Range[] =>
  (text ?? '').split(',').flatMap((word) => {
    const match = /^(.+):(.*)\.\.(.*)$/.exec(word);
    if (!match) return [];
    const [low, high] = [match[2] === '' ? -Infinity : Number(match[2]), match[3] === '' ? Infinity : Number(match[3])];
    return Number.isNaN(low) || Number.isNaN(high) ? [] : [{ column: match[1]!, low, high }];
  });

const RANGE_FIGURES = 4; // of the ends of a range that is drawn with the pointer

export const rangesText = (ranges: Range[]): string | undefined => {
  const end = (value: number) => (Number.isFinite(value) ? String(Number(value.toPrecision(RANGE_FIGURES))) : '');
  return ranges.map((each) => `${each.column}:${end(each.low)}..${end(each.high)}`).join(',') || undefined;
};

/** The rows at a condition (null: at all of them) in an order; rows without a value come last. */
export function orderedRows(rows: Rows, condition: number | null, order: Column | undefined, isDescending: boolean): number[] {
  const out = rows.candidates.map((_, row) => row).filter((row) => condition === null || rows.conditions[row] === condition);
  if (!order) return out;
  const sign = isDescending ? -1 : 1;
  return out.sort((a, b) => {
    const [x, y] = [order.values[a] ?? null, order.values[b] ?? null];
    if (x === null || y === null) return Number(x === null) - Number(y === null);
    return sign * (x - y) || a - b;
  });
}

/** Whether a row lies within all ranges. */
export const isWithin = (rows: Rows, ranges: Range[]): ((row: number) => boolean) => {
  const found = ranges.flatMap((range) => {
    const column = rows.columns.find((each) => each.name === range.column);
    return column ? [{ ...range, values: column.values }] : [];
  });
  return (row) => found.every(({ values, low, high }) => {
    const value = values[row];
    return value !== null && value !== undefined && value >= low && value <= high;
  });
};

/** Whether a column says something about the rows: it has two values at least. */
export const varies = (column: Column, rows: number[]): boolean => {
  const first = rows.map((row) => column.values[row]).find((value) => value != null);
  return rows.some((row) => column.values[row] != null && column.values[row] !== first);
};

/** The least and the greatest value of a column in its shown unit; null without values. */
export function extentOf(values: (number | null | undefined)[]): [number, number] | null {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value == null) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return low > high ? null : [low, high];
}
