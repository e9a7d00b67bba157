import type { CycleLubricant, CyclePart, CyclePartKind, CyclePlace, EvaluateCycleRequest, EvaluateCycleResponse } from './api/types';
import { tableOf, type Table } from './candidates';
import { finite } from './components/num';
import type { Line, Spec } from './charts/spec';
import { modelBodyOf, modelFlagsOf, modelQueryOf, modelRequestOf, type Model } from './model';
import { plain, readNumber, shown, watts, type Unit } from './units';

/** What the form of a cycle holds. */
export interface CycleRequest extends Model {
  fluids: string[]; // ids, with or without "@revision"; others are compared with the first
  isOwn: boolean; // a dropped cycle in place of the NEDC
  sump: number; // [C]
  gearSet: string; // ids; "": those of the paper
  surface: string;
  vehicle: string;
  isSheared: boolean;
}

const USUAL_SUMP = 40; // [C], of the service

const words = (text: string | null): string[] => (text ?? '').split(',').filter((each) => each !== '');

export const cycleRequestOf = (query: URLSearchParams): CycleRequest => ({
  fluids: words(query.get('f')), isOwn: query.get('cycle') === 'own', sump: query.has('sump') ? Number(query.get('sump')) : USUAL_SUMP,
  gearSet: query.get('gear') ?? '', surface: query.get('surface') ?? '', vehicle: query.get('vehicle') ?? '',
  ...modelRequestOf(query), isSheared: query.get('sheared') === '1',
});

export const cycleQueryOf = (request: CycleRequest): Record<string, string | undefined> => ({
  f: request.fluids.join(',') || undefined, cycle: request.isOwn ? 'own' : undefined, sump: request.sump === USUAL_SUMP ? undefined : String(request.sump),
  gear: request.gearSet || undefined, surface: request.surface || undefined, vehicle: request.vehicle || undefined,
  ...modelQueryOf(request), sheared: request.isSheared ? '1' : undefined,
});

export const cycleBodyOf = (request: CycleRequest, places: CyclePlace[]): EvaluateCycleRequest => ({
  lubricants: request.fluids.map((each) => `lubricants/${each}`),
  ...(request.gearSet ? { gear_set: `gearSets/${request.gearSet}` } : {}),
  ...(request.surface ? { surface: `surfaces/${request.surface}` } : {}),
  ...(request.vehicle ? { vehicle: `vehicles/${request.vehicle}` } : {}),
  ...modelBodyOf(request),
  sump_temperature_celsius: request.sump, sheared_lubricant: request.isSheared,
  ...(request.isOwn ? { places } : { named_cycle: 'NAMED_CYCLE_NEDC' as const }),
});

/** The command that computes the same energies. */
export const cycleCommandOf = (request: CycleRequest, file: string, project: string): string => [
  'tribodyn', ...(project === 'default' ? [] : ['--project', project]), 'cycle', ...request.fluids,
  ...(request.isOwn ? ['--cycle', `'${file}'`] : []), '--sump', request.sump,
  ...(request.gearSet ? ['--gear-set', request.gearSet] : []), ...(request.surface ? ['--surface', request.surface] : []),
  ...(request.vehicle ? ['--vehicle', request.vehicle] : []), ...(request.isSheared ? ['--condition', 'sheared'] : []),
  ...modelFlagsOf(request),
].join(' ');

/** The columns of a file of a cycle, as the command line has them; further columns are not used. */
const COLUMNS: { field: keyof CyclePlace; pattern: RegExp; unit: (header: string) => Unit }[] = [
  { field: 'time_seconds', pattern: /^(time|t)\b|^time_seconds$/i, unit: () => plain('s') },
  // 3.6 is exact: m/s to km/h.
  { field: 'speed_kilometres_per_hour', pattern: /^(speed|v)\b|^speed_/i, unit: (header) => (/m\/s|metres_per_second$/.test(header) ? { symbol: 'm/s', factor: 1 / 3.6, offset: 0 } : plain('km/h')) },
  { field: 'ascent_angle_degrees', pattern: /^(slope|ascent)/i, unit: () => plain('°') },
  { field: 'sump_temperature_celsius', pattern: /^sump/i, unit: (header) => (/\bK\b|kelvin/.test(header) ? { symbol: 'K', factor: 1, offset: 273.15 } : plain('°C')) },
];

/** A fault of a file, at a line counted from 1. */
export interface LineProblem {
  line: number;
  text: string;
}

export interface OwnCycle {
  table: Table;
  places: CyclePlace[];
  problems: LineProblem[];
}

/** Reads a cycle from a text. */
export function ownCycleOf(text: string): OwnCycle {
  const table = tableOf(text);
  const problems: LineProblem[] = [];
  const found = COLUMNS.map(({ pattern }) => table.header.findIndex((each) => pattern.test(each)));
  COLUMNS.slice(0, 2).forEach(({ field }, k) => {
    if (found[k]! < 0) problems.push({ line: 1, text: `the column ${field} is missing` });
  });
  if (problems.length > 0) return { table, places: [], problems };
  const places = table.rows.map(({ line, cells }) => {
    const place: CyclePlace = {};
    COLUMNS.forEach(({ field, unit }, k) => {
      if (found[k]! < 0) return;
      const cell = cells[found[k]!] ?? '';
      const value = readNumber(table.hasDecimalCommas ? cell : cell.replace(',', '?'), unit(table.header[found[k]!]!));
      if (!Number.isFinite(value)) problems.push({ line, text: `${field}: "${cell}" is not a number` });
      place[field] = value;
    });
    return place;
  });
  return { table, places, problems };
}

/** The lines of a file that the service refuses. */
export const lineProblems = (violations: { field: string; description: string }[], table: Table): LineProblem[] =>
  violations.flatMap(({ field, description }) => {
    const match = /places\[(\d+)\](?:\.(\w+))?/.exec(field);
    const row = match && table.rows[Number(match[1])];
    return row ? [{ line: row.line, text: match[2] && !description.startsWith(match[2]) ? `${match[2]}: ${description}` : description }] : [];
  });

/** Parts of a cycle by what the vehicle does. */
export const STATES: Partial<Record<CyclePartKind, string>> = {
  CYCLE_PART_KIND_DRIVE_ACCELERATING: 'Drive, accelerating', CYCLE_PART_KIND_DRIVE_STEADY: 'Drive, steady',
  CYCLE_PART_KIND_DRIVE_DECELERATING: 'Drive, slowing down', CYCLE_PART_KIND_COAST: 'Coast: the wheels drive', CYCLE_PART_KIND_STANDSTILL: 'Standstill',
};
const SUMS: Partial<Record<CyclePartKind, string>> = { CYCLE_PART_KIND_ALL: 'Whole cycle', CYCLE_PART_KIND_DRIVE: 'Drive' };

export function partWords(part: CyclePart): string {
  if (part.kind !== 'CYCLE_PART_KIND_SPEED_BAND') return STATES[part.kind!] ?? SUMS[part.kind!] ?? part.kind!;
  const low = part.minimum_speed_kilometres_per_hour ?? 0;
  return part.maximum_speed_kilometres_per_hour ? `${low} to ${part.maximum_speed_kilometres_per_hour} km/h` : `${low} km/h and above`;
}

/** The speed of the vehicle over time. */
export const speedSpec = (answer: EvaluateCycleResponse): Spec => ({
  title: 'Speed of the vehicle, km/h', xLabel: 'Time, s', yLabel: 'km/h',
  lines: [{ label: '', series: 4, variant: 0, x: answer.start_seconds ?? [], y: answer.speed_kilometres_per_hour ?? [], hollow: [] }],
  parted: [], caution: [], outside: [], levels: [], fromZero: true, hasMarkers: false,
});

/** The mesh loss of each fluid over time. */
export const lossSpec = (answer: EvaluateCycleResponse, titles: string[]): Spec => ({
  title: `Mesh loss, ${watts.symbol}`, xLabel: 'Time, s', yLabel: watts.symbol,
  lines: (answer.lubricants ?? []).flatMap((fluid: CycleLubricant, series): Line[] => ((fluid.mesh_loss_power_watts ?? []).length === 0 ? [] : [{
    label: titles[series]!, series, variant: 0, x: answer.start_seconds ?? [], hollow: [],
    y: fluid.mesh_loss_power_watts!.map((value) => { const number = finite(value); return number === null ? null : shown(number, watts); }),
  }])),
  parted: [], caution: [], outside: [], levels: [], fromZero: true, hasMarkers: false,
});
