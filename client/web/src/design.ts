import { atField } from './api/client';
import type { CandidateDesign, CandidateDesignMethod, Constraint, DesignFactor } from './api/types';
import { unitsOf } from './candidates';
import { plain, readNumber, shown, type Unit } from './units';

/** A factor of a design as the form holds it: texts in a unit. */
export interface Factor {
  parameter: string; // e.g. "lubricant.relaxation_time_seconds"
  minimum: string; // "" at both ends: by the standard uncertainty that the base states
  maximum: string;
  unit: string; // symbol
  isLogarithmic: boolean;
  levels: string; // of a grid
}

export interface Design {
  method: CandidateDesignMethod;
  count: string; // not of a grid
  seed: string;
  factors: Factor[];
}

export const METHODS: [CandidateDesignMethod, string, string][] = [
  ['LATIN_HYPERCUBE', 'Latin hypercube', 'Each factor has one value in each of as many equal parts as there are candidates.'],
  ['SOBOL', 'Sobol', 'Sobol’s sequence with a digital shift; powers of 2 fill the ranges best.'],
  ['GRID', 'Grid', 'Every combination of the levels.'],
];

export const USUAL_DESIGN: Design = { method: 'LATIN_HYPERCUBE', count: '128', seed: '1', factors: [] };

const ROLE = (parameter: string) => `parameter:${parameter}` as const;

/** The units of a factor, that of the service first. */
export const factorUnits = (parameter: string, constraints: Constraint[] | undefined): Unit[] => {
  const all = unitsOf(ROLE(parameter), constraints);
  return all.length > 0 ? all : [plain('')];
};

export const factorUnit = (factor: Factor, constraints: Constraint[] | undefined): Unit => {
  const all = factorUnits(factor.parameter, constraints);
  return all.find((each) => each.symbol === factor.unit) ?? all[0]!;
};

/** The unit in which a value of the base is read with ease. */
export function easyUnit(parameter: string, value: number | undefined, constraints: Constraint[] | undefined): Unit {
  const all = factorUnits(parameter, constraints);
  const isEasy = (unit: Unit) => value !== undefined && (value === 0 || (Math.abs(shown(value, unit)) >= 0.1 && Math.abs(shown(value, unit)) < 1e4));
  return all.find(isEasy) ?? all[0]!;
}

/** Something wrong in the form, at a field named as the service names it, e.g. "factors[1].minimum". */
export interface DesignProblem {
  field: string;
  text: string;
}

/** The design as the service takes it, and the texts that are no numbers. */
export function designBody(design: Design, constraints: Constraint[] | undefined): { body: CandidateDesign; problems: DesignProblem[] } {
  const problems: DesignProblem[] = [];
  const number = (text: string, unit: Unit, field: string): number | undefined => {
    if (text.trim() === '') return undefined;
    const value = readNumber(text, unit);
    if (Number.isFinite(value)) return value;
    problems.push({ field, text: `"${text}" is not a number` });
    return undefined;
  };
  const whole = (text: string, field: string): number | undefined => {
    const value = number(text, plain(''), field);
    if (value === undefined || Number.isInteger(value)) return value;
    problems.push({ field, text: `"${text}" is not a whole number` });
    return undefined;
  };
  const isGrid = design.method === 'GRID';
  const factors = design.factors.map((each, k): DesignFactor => {
    const unit = factorUnit(each, constraints);
    const [minimum, maximum] = [number(each.minimum, unit, `factors[${k}].minimum`), number(each.maximum, unit, `factors[${k}].maximum`)];
    const levels = isGrid ? whole(each.levels, `factors[${k}].levels`) : undefined;
    return {
      parameter: each.parameter, ...(minimum === undefined ? {} : { minimum }), ...(maximum === undefined ? {} : { maximum }),
      ...(each.isLogarithmic ? { scale: 'LOGARITHMIC' as const } : {}), ...(levels === undefined ? {} : { levels }),
    };
  });
  const count = isGrid ? undefined : whole(design.count, 'count');
  const seed = isGrid ? undefined : whole(design.seed, 'seed');
  return {
    body: { method: design.method, ...(count === undefined ? {} : { count }), ...(seed === undefined ? {} : { seed: String(seed) }), factors },
    problems,
  };
}

/** What the service says of a field of a design; a word on a factor as a whole stands at its parameter. */
export const designProblems = (violations: { field: string; description: string }[]): DesignProblem[] =>
  violations.flatMap(({ field, description }) => {
    const match = /candidate_design(?:\.(.*))?$/.exec(field);
    return match ? [{ field: (match[1] ?? 'method').replace(/^(factors\[\d+\])$/, '$1.parameter'), text: atField(description) }] : [];
  });
