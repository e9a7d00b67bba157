import type { WarningLevel } from './api/types';

/** How far a result may be relied on: a note restricts nothing, `outside` forbids to rank by it. */
export type Level = 'note' | 'caution' | 'outside';

/** A warning of the service: of points, rows, candidates or inputs. */
export interface Warning {
  code?: string;
  summary?: string;
  level?: WarningLevel;
  message?: string;
  sentence?: string; // of a characterisation, in place of the message
}

/** A sentence about the validity of a result. */
export interface Remark {
  code: string;
  words: string; // a few, for headings
  level: Level;
  where: string; // for what it holds, e.g. "20 to 70 km/h"; empty: for all
  message: string; // of the service
}

const LEVELS: Partial<Record<WarningLevel, Level>> = { WARNING_LEVEL_CAUTION: 'caution', WARNING_LEVEL_WITHHOLDS_VERDICT: 'outside' };

export const levelOf = (warning: Warning): Level => LEVELS[warning.level!] ?? 'note';

export const remarkOf = (warning: Warning, where = ''): Remark => ({
  code: warning.code ?? '', where, level: levelOf(warning),
  words: warning.summary || (warning.code ?? '').toLowerCase().replaceAll('_', ' '), message: warning.message ?? warning.sentence ?? '',
});

/** A warning and for what it holds; empty: for all. */
export interface Placed {
  warning: Warning;
  where: string;
}

/** Warnings as remarks, one for each code with all places that it holds for; estimates of parameters have one sentence each. */
export function remarksAt(placed: Placed[]): Remark[] {
  const all = new Map<string, { warning: Warning; places: Set<string> }>();
  for (const { warning, where } of placed) {
    const key = warning.code === 'PARAMETER_ESTIMATED' ? warning.message! : warning.code!;
    const known = all.get(key) ?? { warning, places: new Set() };
    all.set(key, known);
    if (where !== '') known.places.add(where);
  }
  return [...all.values()].map(({ warning, places }) => remarkOf(warning, [...places].join('; ')));
}

export const remarksOnce = (warnings: Warning[]): Remark[] => remarksAt(warnings.map((warning) => ({ warning, where: '' })));

/** "20 to 70, 80": runs of neighbours among places in ascending order; empty: all of them. */
export function runsText(places: number[], isAffected: (place: number, k: number) => boolean, text: (place: number) => string): string {
  const runs: number[][] = [];
  let isOpen = false;
  places.forEach((place, k) => {
    const isIn = isAffected(place, k);
    if (isIn && isOpen) runs.at(-1)!.push(place);
    else if (isIn) runs.push([place]);
    isOpen = isIn;
  });
  if (runs.length === 1 && runs[0]!.length === places.length) return '';
  return runs.map((run) => (run.length === 1 ? text(run[0]!) : `${text(run[0]!)} to ${text(run.at(-1)!)}`)).join(', ');
}

/** Remarks in a line each, for the foot of a figure or table. */
export const remarkLines = (remarks: Remark[]): string[] =>
  remarks.map((each) => `${each.words}${each.where && `, at ${each.where}`}: ${each.message} [${each.code}]`);

/** The level that decides for a result with these remarks. */
export const worstOf = (remarks: Remark[]): 'ok' | 'caution' | 'outside' =>
  remarks.some((each) => each.level === 'outside') ? 'outside' : remarks.some((each) => each.level === 'caution') ? 'caution' : 'ok';
