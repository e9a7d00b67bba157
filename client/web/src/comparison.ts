import type { ComparedDifferenceVerdict, ComparedLubricant, ComparedPoint, ComparePointsRequest, ComparePointsResponse, ExplainPointsRequest, PointCondition, UncertainFigure } from './api/types';
import type { Line, Spec } from './charts/spec';
import { finite, isUncertain } from './components/num';
import { rounded } from './format';
import { isInRpm, metres, plain, RPM, scaled, shown, watts, type Unit } from './units';
import { modelBodyOf, modelFlagsOf, modelQueryOf, modelRequestOf, type Model } from './model';
import { remarksAt, runsText, type Remark } from './validity';

/** What the form of a comparison holds. */
export interface CompareRequest extends Model {
  a: string; // id, with or without "@revision"
  b: string;
  sump: number; // [C]
  gearSet: string; // id; "": the reference axle
  surface: string; // ids with revisions of a link; "": the usual ones
  vehicle: string;
  first: number; // [km/h]
  last: number; // [km/h]
  step: number; // [km/h]
  sumpUncertainty: number; // [K]
  correlation: number; // of estimates
}

const USUAL = { sump: 40, first: 20, last: 140, step: 10, sumpUncertainty: 0, correlation: 0.5 };
const WORDS: Record<keyof typeof USUAL, string> = { sump: 'sump', first: 'from', last: 'to', step: 'step', sumpUncertainty: 'dsump', correlation: 'corr' };

export function compareRequestOf(query: URLSearchParams): CompareRequest {
  const numbers = Object.fromEntries(Object.entries(WORDS).map(([key, word]) =>
    [key, query.has(word) ? Number(query.get(word)) : USUAL[key as keyof typeof USUAL]])) as typeof USUAL;
  return {
    a: query.get('a') ?? '', b: query.get('b') ?? '', gearSet: query.get('gear') ?? '', surface: query.get('surface') ?? '', vehicle: query.get('vehicle') ?? '',
    ...modelRequestOf(query), ...numbers,
  };
}

export function compareQueryOf(request: CompareRequest): Record<string, string | undefined> {
  return {
    a: request.a || undefined, b: request.b || undefined, gear: request.gearSet || undefined,
    surface: request.surface || undefined, vehicle: request.vehicle || undefined, ...modelQueryOf(request),
    ...Object.fromEntries(Object.entries(WORDS).map(([key, word]) => {
      const value = request[key as keyof typeof USUAL];
      return [word, value === USUAL[key as keyof typeof USUAL] ? undefined : String(value)];
    })),
  };
}

const MOST_SPEEDS = 1000;

/** The speeds of a range, as the server forms those of a curve. */
export function speedsOf(request: { first: number; last: number; step: number }): number[] {
  const speeds: number[] = [];
  if (!(request.step > 0)) return [request.first];
  for (let i = 0; speeds.length < MOST_SPEEDS; ++i) {
    const speed = Number((request.first + i * request.step).toPrecision(12));
    if (speed > request.last) break;
    speeds.push(speed);
  }
  return speeds;
}

const conditionOf = (request: CompareRequest, speed: number): PointCondition =>
  ({ speed_kilometres_per_hour: speed, sump_temperature_celsius: request.sump });

const common = (request: CompareRequest) => ({
  ...(request.gearSet ? { gear_set: `gearSets/${request.gearSet}` } : {}),
  ...(request.surface ? { surface: `surfaces/${request.surface}` } : {}),
  ...(request.vehicle ? { vehicle: `vehicles/${request.vehicle}` } : {}),
  ...modelBodyOf(request),
  ...(request.sumpUncertainty !== 0 ? { sump_temperature_uncertainty_kelvin: request.sumpUncertainty } : {}),
  estimate_correlation: request.correlation,
});

export const compareBodyOf = (request: CompareRequest): ComparePointsRequest => ({
  lubricants: [`lubricants/${request.a}`, `lubricants/${request.b}`],
  ...common(request),
  conditions: speedsOf(request).map((speed) => conditionOf(request, speed)),
});

const MOST_POINTS_PER_COMBINATION = 1000; // 64000 points of ExplainPoints over 64 combinations
const USUAL_DRAWS = 99;

/** Explains the difference at some speeds, with as many draws as the service allows for them. */
export const explainBodyOf = (request: CompareRequest, speeds: number[]): ExplainPointsRequest => ({
  lubricant: `lubricants/${request.a}`,
  other_lubricant: `lubricants/${request.b}`,
  ...common(request),
  conditions: speeds.map((speed) => conditionOf(request, speed)),
  draws: Math.min(USUAL_DRAWS, Math.floor(MOST_POINTS_PER_COMBINATION / speeds.length) - 1),
});

const flagsOf = (request: CompareRequest, speeds: number[], project: string): string =>
  [...(project === 'default' ? [] : ['--project', project]), '--speeds', speeds.join(','), '--sump-temperature-celsius', request.sump,
    ...(request.gearSet ? ['--gear-set', request.gearSet] : []), ...(request.surface ? ['--surface', request.surface] : []),
    ...(request.vehicle ? ['--vehicle', request.vehicle] : []),
    ...(request.sumpUncertainty !== 0 ? ['--sump-temperature-uncertainty-kelvin', request.sumpUncertainty] : []),
    '--estimate-correlation', request.correlation,
    ...modelFlagsOf(request)].join(' ');

/** Commands that compute the same figures. */
export const compareCommandsOf = (request: CompareRequest, explained: number[], project: string): string[] => [
  `tribodyn compare ${request.a} ${request.b} ${flagsOf(request, speedsOf(request), project)}`,
  `tribodyn explain ${request.a} ${request.b} ${flagsOf(request, explained, project)}`,
];

/** A figure of compared points. */
export interface ComparedQuantity {
  id: string; // in addresses
  label: string;
  unit: Unit;
  figure: (point: ComparedPoint) => UncertainFigure | undefined;
}

export const COMPARED: ComparedQuantity[] = [
  { id: 'inefficiency', label: 'Mesh inefficiency', unit: plain('%'), figure: (point) => point.inefficiency_energy_mean_percent },
  { id: 'loss', label: 'Mesh loss', unit: watts, figure: (point) => point.mesh_loss_power_watts },
  { id: 'torque', label: 'Pinion torque', unit: plain('N m'), figure: (point) => point.pinion_torque_newton_metres },
  { id: 'dte-least', label: 'Least transmission error', unit: metres, figure: (point) => point.dynamic_transmission_error_minimum_metres },
  { id: 'dte-greatest', label: 'Greatest transmission error', unit: metres, figure: (point) => point.dynamic_transmission_error_maximum_metres },
];

export const POINTS: Unit = plain('% points');

const mapped = (value: number | string | undefined, unit: Unit): number | null => {
  const number = finite(value);
  return number === null ? null : shown(number, unit);
};

/** What a verdict says of a lubricant beside the reference. */
export const VERDICTS: Record<ComparedDifferenceVerdict, string> = {
  VERDICT_UNSPECIFIED: 'no figure', LOWER: 'loses less', HIGHER: 'loses more', CANNOT_BE_TOLD_APART: 'cannot be told apart',
  WITHHELD: 'no verdict: a warning withholds it', UNCERTAINTY_NOT_STATED: 'no verdict: uncertainty not stated',
};

/** A verdict in a sentence about both. */
export function verdictWords(verdict: ComparedDifferenceVerdict | undefined, a: string, b: string): string {
  const words = VERDICTS[verdict ?? 'VERDICT_UNSPECIFIED'];
  if (verdict === 'CANNOT_BE_TOLD_APART') return `${a} and ${b} ${words}`;
  return verdict === 'LOWER' || verdict === 'HIGHER' ? `${b} ${words}` : `${a} and ${b}: ${words}`;
}

/** The warnings of compared lubricants, each with the lubricants and speeds that it holds for. */
export const comparedRemarks = (lubricants: ComparedLubricant[], titles: string[], speeds: number[], unit: Unit): Remark[] =>
  remarksAt(lubricants.flatMap((lubricant, k) => {
    const points = lubricant.points ?? [];
    const all = new Map(points.flatMap((point) => (point.warnings ?? []).map((warning) => [warning.code, warning] as const)));
    return [...all].map(([code, warning]) => {
      const runs = runsText(speeds, (_, row) => points[row]?.warnings?.some((each) => each.code === code) === true, (speed) => speedText(speed, unit));
      return { warning, where: `${titles[k]}${runs && ` ${runs}`}` };
    });
  }));

/** A line with the interval of its figures over speeds, where the inputs decide one. */
export function intervalLine(label: string, series: number, speeds: number[], figures: (UncertainFigure | undefined)[], unit: Unit, hollow: boolean[]): Line {
  const column = (read: (figure: UncertainFigure) => number | undefined) =>
    figures.map((figure) => (figure === undefined ? null : mapped(read(figure), unit)));
  return {
    label, series, variant: 0, x: speeds, hollow,
    y: column((figure) => figure.value),
    low: column((figure) => (isUncertain(figure) ? figure.interval_minimum : undefined)),
    high: column((figure) => (isUncertain(figure) ? figure.interval_maximum : undefined)),
    error: figures.map((figure) => (figure === undefined ? null : mapped(figure.solver_error, { ...unit, offset: 0 }))),
  };
}

/** A figure without an interval if nobody stated an uncertainty. */
const statedFigure = (figure: UncertainFigure | undefined, isStated: boolean): UncertainFigure | undefined =>
  (isStated || figure === undefined ? figure : { value: figure.value, solver_error: figure.solver_error });

/** The unit of the axis of speeds: those of the pinion, which the service answers, are proportional to those of the vehicle. */
export function comparedSpeedUnit(answer: ComparePointsResponse | null | undefined, speeds: number[]): Unit {
  const pinion = answer?.mean_pinion_speed_radians_per_second?.[0];
  return isInRpm() && pinion !== undefined ? scaled(RPM.symbol, (RPM.factor * pinion) / speeds[0]!) : plain('km/h');
}

export const speedLabelOf = (unit: Unit): string => (unit.symbol === RPM.symbol ? 'Mean speed of the pinion, rpm' : 'Vehicle speed, km/h');

/** A speed in words: "60 km/h" or "1635 rpm". */
export const speedText = (speed: number, unit: Unit): string => (unit.symbol === RPM.symbol ? `${rounded(shown(speed, unit), 1)} rpm` : `${speed} km/h`);

/** Figures of lubricants over places of the axis. */
export function figuresSpec(lubricants: ComparedLubricant[], titles: string[], speeds: number[], quantity: ComparedQuantity, xLabel: string): Spec {
  return {
    title: `${quantity.label}, ${quantity.unit.symbol}`, xLabel, yLabel: quantity.unit.symbol,
    lines: lubricants.map((lubricant, k) => {
      const points = lubricant.points ?? [];
      return intervalLine(titles[k]!, k, speeds, points.map((point) => (point.refusal_reason ? undefined : statedFigure(quantity.figure(point), lubricant.uncertainty_stated === true))),
        quantity.unit, points.map((point) => point.contact_loss === true));
    }),
    parted: [], caution: [], outside: [], levels: [], fromZero: false,
  };
}

/** Differences from the first lubricant over places of the axis: hollow where they are no verdict. */
export function differenceSpec(lubricants: ComparedLubricant[], titles: string[], speeds: number[], series: number[], xLabel: string): Spec {
  return {
    title: `Difference from ${titles[0]}, percentage points`, xLabel, yLabel: '% points',
    lines: lubricants.slice(1).map((lubricant, k) => {
      const differences = lubricant.differences ?? [];
      return intervalLine(titles[k + 1]!, series[k + 1]!, speeds, differences.map((each) => statedFigure(each.difference_percent, each.verdict !== 'UNCERTAINTY_NOT_STATED')), POINTS,
        differences.map((each) => each.verdict !== 'LOWER' && each.verdict !== 'HIGHER'));
    }),
    parted: [], caution: [], outside: [], levels: [{ value: 0, label: '' }], fromZero: false,
  };
}

export const GROUPS: Record<string, string> = {
  PARAMETER_GROUP_VISCOSITY: 'Viscosity and its temperature law',
  PARAMETER_GROUP_PRESSURE_RESPONSE: 'Rise of viscosity with pressure',
  PARAMETER_GROUP_SHEAR_THINNING: 'Shear thinning',
  PARAMETER_GROUP_LIMITING_STRESS: 'Limiting shear stress',
  PARAMETER_GROUP_THERMAL_PROPERTIES: 'Conductivity and density',
  PARAMETER_GROUP_BOUNDARY_FILM: 'Boundary film',
};
