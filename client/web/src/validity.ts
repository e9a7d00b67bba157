import type { CharacterisationWarning, RangeWarning } from './api/types';

/** How far a result may be relied on: a note restricts nothing, `outside` forbids to rank by it. */
export type Level = 'note' | 'caution' | 'outside';

/** A sentence about the validity of a result. */
export interface Remark {
  code: string;
  words: string; // a few, for headings
  level: Level;
  where: string; // for what it holds, e.g. "20 to 70 km/h"; empty: for all
  message: string; // of the service
}

const WARNINGS: Record<string, { words: string; level: Level }> = {
  COLD_INLET: { words: 'cold inlet: do not rank oils here', level: 'outside' },
  FILM_RATIO: { words: 'film thinner than the asperity model holds for', level: 'caution' },
  LIMITING_STRESS: { words: 'most of the loaded area at the limiting shear stress', level: 'caution' },
  PRESSURE: { words: 'pressure outside the range in which friction was measured', level: 'caution' },
  RADIUS_RATIO: { words: 'contact ellipse slimmer than the fits hold for', level: 'caution' },
  ROUGHNESS_PRODUCT: { words: 'roughness outside the range of the asperity model', level: 'caution' },
  VISCOSITY_TEMPERATURE: { words: 'temperature outside the range in which viscosity was measured', level: 'caution' },
  ISOTHERMAL: { words: 'isothermal model', level: 'note' },
  NOT_SETTLED: { words: 'no steady period: averages over a record', level: 'note' },
  PERIOD: { words: 'response with a period of several mesh cycles', level: 'note' },
  QUASI_STATIC: { words: 'quasi-static model', level: 'note' },
  PARAMETER_ESTIMATED: { words: 'some parameters are estimated', level: 'note' },
  RESPONSES_COEXIST: { words: 'another response at the same point', level: 'caution' },
  RATTLES: { words: 'rattle: averages with a statistical error', level: 'caution' },
  FLANKS_TAP: { words: 'flanks tap each other under hardly any load', level: 'caution' },
  BARELY_ATTRACTS: { words: 'response that hardly attracts', level: 'note' },
  NO_SENSITIVITIES: { words: 'no sensitivities', level: 'note' },
};

export function warningOf(code: string): { words: string; level: Level } {
  const words = code.toLowerCase().replaceAll('_', ' ');
  return WARNINGS[code] ?? { words, level: /_(ESTIMATED|ASSUMED|UNSPECIFIED|UNUSED|UNDEFINED)$/.test(code) ? 'note' : 'caution' };
}

export const remarkOf = (warning: RangeWarning | CharacterisationWarning, where = ''): Remark => ({
  code: warning.code ?? '', where, ...warningOf(warning.code ?? ''),
  message: ('sentence' in warning ? warning.sentence : (warning as RangeWarning).message) ?? '',
});

/** Warnings as remarks, one for each code; estimates of parameters have one sentence each. */
export function remarksOnce(warnings: RangeWarning[]): Remark[] {
  const all = new Map(warnings.map((each) => [each.code === 'PARAMETER_ESTIMATED' ? each.message : each.code, each] as const));
  return [...all.values()].map((each) => remarkOf(each));
}

/** The level that decides for a result with these remarks. */
export const worstOf = (remarks: Remark[]): 'ok' | 'caution' | 'outside' =>
  remarks.some((each) => each.level === 'outside') ? 'outside' : remarks.some((each) => each.level === 'caution') ? 'caution' : 'ok';
