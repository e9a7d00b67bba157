import type { EvaluateRigRequest, EvaluateRigResponse, RigBody, RigCondition } from './api/types';
import type { Line, Spec } from './charts/spec';
import { finite, isUncertain, type Figure } from './components/num';
import { modelBodyOf, modelFlagsOf, modelQueryOf, modelRequestOf, optionWords, type Model } from './model';
import { celsius, kelvin, metres, pascals, plain, scaled, shown, written, type Unit } from './units';
import { levelOf, remarksAt, runsText, type Remark } from './validity';

export type RigKind = 'traction' | 'film' | 'stribeck';

/** What the form of a rig holds. Lists have a curve for each of their values. */
export interface RigRequest extends Model {
  kind: RigKind;
  fluids: string[]; // ids, with or without "@revision"
  loads: number[]; // [N]
  speeds: number[]; // [m/s]; of a traction curve
  slides: number[]; // [%]; of the others
  temperatures: number[]; // [C]
  radius: number; // of the ball [mm]
  disc: 'steel' | 'glass';
  surface: string; // id; "": smooth specimens
  roughness: number; // sigma_G [nm]; 0: that of the surface
  hasBands: boolean; // of the uncertainty of the inputs
}

const LEAST_SPEED = { film: 0.03, stribeck: 0.003 }; // [m/s]
const SPEEDS_PER_DECADE = 6;
const MOST_SPEED = 3; // [m/s]
const DRAWS = 199; // of the inputs: the 95 % interval ends at the fifth from either end

const speedsFrom = (first: number): number[] => {
  const steps = Math.round(SPEEDS_PER_DECADE * Math.log10(MOST_SPEED / first));
  return Array.from({ length: steps + 1 }, (_, i) => Number((first * (MOST_SPEED / first) ** (i / steps)).toPrecision(6)));
};

/** A kind of rig: what it varies, what it shows first, and its machine if nobody states another. */
export const RIGS: Record<RigKind, { label: string; about: string; swept: number[]; x: { label: string; isLogarithmic: boolean }; first: string; usual: Omit<RigRequest, 'kind' | 'fluids' | 'hasBands' | 'preset'> }> = {
  traction: {
    label: 'Traction', about: 'Friction of a ball on a disc against the slide-roll ratio',
    swept: [0, 0.25, 0.5, 1, 1.5, 2, 3, 4, 5, 7, 10, 15, 20, 25, 30, 35, 40, 45, 50],
    x: { label: 'Slide-roll ratio, %', isLogarithmic: false }, first: 'traction',
    usual: { loads: [35], speeds: [2], slides: [], temperatures: [40], radius: 9.525, disc: 'steel', surface: '', roughness: 0, options: [] },
  },
  film: {
    label: 'Film', about: 'Central film of a ball that rolls on glass against speed, as interferometry measures it',
    swept: speedsFrom(LEAST_SPEED.film), x: { label: 'Entrainment speed, m/s', isLogarithmic: true }, first: 'film',
    usual: { loads: [20], speeds: [], slides: [0], temperatures: [40], radius: 9.525, disc: 'glass', surface: '', roughness: 0, options: [] },
  },
  stribeck: {
    label: 'Stribeck', about: 'Friction of a rough ball on a disc against speed, from boundary friction to full films',
    swept: speedsFrom(LEAST_SPEED.stribeck), x: { label: 'Entrainment speed, m/s', isLogarithmic: true }, first: 'traction',
    usual: { loads: [35], speeds: [], slides: [50], temperatures: [40], radius: 9.525, disc: 'steel', surface: 'run-in', roughness: 20, options: [] },
  },
};

/** A figure of a rig. */
export interface RigQuantity {
  id: string; // in addresses
  label: string;
  column: keyof EvaluateRigResponse;
  unit: Unit;
  isLogarithmic?: boolean; // over a logarithmic axis of speeds
}

export const RIG_QUANTITIES: RigQuantity[] = [
  { id: 'traction', label: 'Friction coefficient', column: 'traction_coefficient', unit: plain('') },
  { id: 'film', label: 'Central film', column: 'central_film_thickness_metres', unit: metres, isLogarithmic: true },
  { id: 'ratio', label: 'Film ratio', column: 'film_ratio', unit: plain(''), isLogarithmic: true },
  { id: 'temperature', label: 'Contact temperature', column: 'contact_temperature_kelvin', unit: kelvin },
  { id: 'flash', label: 'Flash temperature rise', column: 'flash_temperature_rise_kelvin', unit: plain('K') },
  { id: 'pressure', label: 'Maximum pressure', column: 'maximum_pressure_pascals', unit: pascals },
  { id: 'boundary', label: 'Boundary share', column: 'boundary_friction_share', unit: scaled('%', 100) },
  { id: 'limit', label: 'Area at the limiting stress', column: 'limiting_stress_area_share', unit: scaled('%', 100) },
];

const NUMBERS = { loads: 'load', speeds: 'speed', slides: 'srr', temperatures: 't' } as const;
type ListKey = keyof typeof NUMBERS;
export const LISTS = Object.keys(NUMBERS) as ListKey[];

const words = (text: string | null): string[] => (text ?? '').split(',').filter((each) => each !== '');

export function rigRequestOf(query: URLSearchParams): RigRequest {
  const kind = (query.get('kind') ?? 'traction') in RIGS ? ((query.get('kind') ?? 'traction') as RigKind) : 'traction';
  const usual = RIGS[kind].usual;
  const lists = Object.fromEntries(LISTS.map((key) => [key, query.has(NUMBERS[key]) ? words(query.get(NUMBERS[key])).map(Number) : usual[key]])) as Pick<RigRequest, ListKey>;
  return {
    kind, fluids: words(query.get('f')), ...lists,
    radius: query.has('radius') ? Number(query.get('radius')) : usual.radius,
    disc: query.get('disc') === 'glass' ? 'glass' : query.get('disc') === 'steel' ? 'steel' : usual.disc,
    surface: query.has('surface') ? (query.get('surface') === 'smooth' ? '' : query.get('surface')!) : usual.surface,
    roughness: query.has('rough') ? Number(query.get('rough')) : usual.roughness,
    ...modelRequestOf(query), hasBands: query.get('u') !== '0',
  };
}

export function rigQueryOf(request: RigRequest): Record<string, string | undefined> {
  const usual = RIGS[request.kind].usual;
  const unless = (value: string, otherwise: string) => (value === otherwise ? undefined : value);
  return {
    kind: unless(request.kind, 'traction'), f: request.fluids.join(',') || undefined,
    ...Object.fromEntries(LISTS.map((key) => [NUMBERS[key], unless(request[key].join(','), usual[key].join(','))])),
    radius: unless(String(request.radius), String(usual.radius)), disc: unless(request.disc, usual.disc),
    surface: unless(request.surface || 'smooth', usual.surface || 'smooth'), rough: unless(String(request.roughness), String(usual.roughness)),
    ...modelQueryOf(request), u: request.hasBands ? undefined : '0',
  };
}

/** Glass of interferometers, as the command line has it. */
const GLASS: RigBody = {
  youngs_modulus_pascals: 75e9, poissons_ratio: 0.22, thermal_conductivity_watts_per_metre_kelvin: 1.1,
  density_kilograms_per_cubic_metre: 2500, specific_heat_capacity_joules_per_kilogram_kelvin: 840,
};

/** The settings of one curve: all but the quantity that varies along it. */
export interface RigSetting {
  load: number;
  speed: number | null;
  slide: number | null;
  temperature: number;
}

const settingsOf = (request: RigRequest): RigSetting[] =>
  request.temperatures.flatMap((temperature) => request.loads.flatMap((load): RigSetting[] =>
    (request.kind === 'traction' ? request.speeds.map((speed) => ({ load, speed, slide: null, temperature }))
      : request.slides.map((slide) => ({ load, speed: null, slide, temperature })))));

const conditionOf = (setting: RigSetting, swept: number): RigCondition => ({
  load_newtons: setting.load, supply_temperature_celsius: setting.temperature,
  entrainment_speed_metres_per_second: setting.speed ?? swept, slide_roll_ratio_percent: setting.slide ?? swept,
});

/** A call of the service: one fluid, with or without an option that is compared. */
export interface RigCall {
  fluid: string;
  model: string; // words of its options
  body: EvaluateRigRequest;
}

/** All calls of a request; chosen options stand beside the full model. */
export function callsOf(request: RigRequest): RigCall[] {
  const models = [[], ...(request.options.length > 0 ? [request.options] : [])];
  return request.fluids.flatMap((fluid) => models.map((options) => ({
    fluid, model: models.length === 1 ? '' : optionWords(options) || 'full model',
    body: {
      lubricant: `lubricants/${fluid}`,
      ...(request.surface ? { surface: `surfaces/${request.surface}` } : {}),
      ...(request.surface && request.roughness > 0 ? { composite_rms_height_metres: Number((1e-9 * request.roughness).toPrecision(12)) } : {}),
      radius_x_metres: Number((1e-3 * request.radius).toPrecision(12)),
      ...(request.disc === 'glass' ? { body_2: GLASS } : {}),
      ...modelBodyOf({ preset: request.preset, options }),
      ...(request.hasBands ? { draws: DRAWS } : {}),
      conditions: settingsOf(request).flatMap((setting) => RIGS[request.kind].swept.map((swept) => conditionOf(setting, swept))),
    },
  })));
}

/** A curve of a rig: rows of one answer. */
export interface RigCurve {
  fluid: string;
  label: string; // of what differs from curves of the same fluid
  x: number[];
  answer: EvaluateRigResponse;
  firstRow: number;
}

export function rigCurvesOf(request: RigRequest, answers: { call: RigCall; answer: EvaluateRigResponse }[]): RigCurve[] {
  const settings = settingsOf(request);
  const { swept } = RIGS[request.kind];
  const differs = (read: (setting: RigSetting) => unknown) => new Set(settings.map(read)).size > 1;
  return answers.flatMap(({ call, answer }) => settings.map((setting, k) => ({
    fluid: call.fluid, x: swept, answer, firstRow: k * swept.length,
    label: [
      differs((each) => each.load) ? `${setting.load} N` : '',
      differs((each) => each.speed) ? `${setting.speed} m/s` : '',
      differs((each) => each.slide) ? `${setting.slide} %` : '',
      differs((each) => each.temperature) ? `${written(setting.temperature, celsius)} ${celsius.symbol}` : '',
      call.model,
    ].filter((each) => each !== '').join(', '),
  })));
}

/** The value of a figure at a row of a curve; null where the row is refused or the figure does not exist. */
export const rigValue = (curve: RigCurve, quantity: RigQuantity, row: number): number | null =>
  finite((curve.answer[quantity.column] as (number | string)[] | undefined)?.[curve.firstRow + row]);

/** What the uncertainty of the inputs makes of a figure at a row; null if it does not move the figure, or the model refused too many draws. */
export function rigBand(curve: RigCurve, quantity: RigQuantity, row: number): Figure | null {
  const band = curve.answer.uncertainties?.find((each) => each.figure === quantity.column);
  const at = (column?: (number | string)[]) => finite(column?.[curve.firstRow + row]);
  const figure = {
    value: rigValue(curve, quantity, row), standard_uncertainty: at(band?.standard_uncertainty),
    interval_minimum: at(band?.interval_minimum), interval_maximum: at(band?.interval_maximum),
  };
  return isUncertain(figure) && figure.interval_minimum !== null && figure.interval_maximum !== null ? figure : null;
}

/** The warnings of rows of curves, each with the curves and places of the axis that it holds for. */
export const rigRemarks = (request: RigRequest, curves: RigCurve[], titleOf: (fluid: string) => string): Remark[] => {
  const symbol = RIGS[request.kind].x.label.split(', ')[1]!;
  return remarksAt(curves.flatMap((curve) => (curve.answer.range_warnings ?? []).flatMap((warning) => {
    const rows = new Set(warning.rows ?? []);
    if (!curve.x.some((_, row) => rows.has(curve.firstRow + row))) return [];
    const runs = runsText(curve.x, (_, row) => rows.has(curve.firstRow + row), (x) => `${x}`);
    return [{ warning, where: `${[titleOf(curve.fluid), curve.label].filter((each) => each !== '').join(', ')}${runs && ` ${runs} ${symbol}`}` }];
  })));
};

/** The codes of the warnings of a row, with blanks between them. */
export const codesAt = (curve: RigCurve, row: number): string =>
  (curve.answer.range_warnings ?? []).filter((each) => (each.rows ?? []).includes(curve.firstRow + row)).map((each) => each.code).join(' ');

/** Whether a warning of a row forbids to rank by it. */
const isWithheld = (curve: RigCurve, row: number): boolean =>
  (curve.answer.range_warnings ?? []).some((each) => levelOf(each) === 'outside' && (each.rows ?? []).includes(curve.firstRow + row));

export function rigSpec(request: RigRequest, curves: RigCurve[], quantity: RigQuantity, titleOf: (fluid: string) => string): Spec {
  const rig = RIGS[request.kind];
  const isLogarithmic = rig.x.isLogarithmic && quantity.isLogarithmic === true;
  const variants = [...new Set(curves.map((each) => each.label))];
  const lines: Line[] = curves.map((curve) => ({
    label: [titleOf(curve.fluid), curve.label].filter((each) => each !== '').join(', '),
    series: request.fluids.indexOf(curve.fluid), variant: variants.indexOf(curve.label), x: curve.x,
    y: curve.x.map((_, row) => {
      const value = rigValue(curve, quantity, row);
      return value === null || (isLogarithmic && value <= 0) ? null : shown(value, quantity.unit);
    }),
    hollow: curve.x.map((_, row) => isWithheld(curve, row)),
    ...endsOf(curve, quantity, isLogarithmic),
  }));
  return {
    title: `${quantity.label}${quantity.unit.symbol && `, ${quantity.unit.symbol}`}`, xLabel: rig.x.label, yLabel: quantity.unit.symbol, lines,
    parted: [], caution: [], outside: [], levels: quantity.id === 'ratio' ? [{ value: 1, label: 'film as high as the roughness' }] : [],
    fromZero: !isLogarithmic && quantity.unit.offset === 0, xRange: [rig.swept[0]!, rig.swept.at(-1)!], xIsLogarithmic: rig.x.isLogarithmic, yIsLogarithmic: isLogarithmic,
  };
}

/** The ends of a curve's band; none where no uncertainty of the inputs moves it. */
function endsOf(curve: RigCurve, quantity: RigQuantity, isLogarithmic: boolean): Pick<Line, 'low' | 'high'> {
  const bands = curve.x.map((_, row) => rigBand(curve, quantity, row));
  if (bands.every((band) => band === null)) return {};
  const end = (name: 'interval_minimum' | 'interval_maximum') => bands.map((band) =>
    (band === null || (isLogarithmic && (band.interval_minimum as number) <= 0) ? null : shown(band[name] as number, quantity.unit)));
  return { low: end('interval_minimum'), high: end('interval_maximum') };
}

/** Commands that compute the same figures. */
export function rigCommandsOf(request: RigRequest, project: string): string[] {
  const { usual } = RIGS[request.kind];
  const list = (flag: string, values: number[]) => (values.length > 0 ? [flag, values.join(',')] : []);
  return [[
    'tribodyn', ...(project === 'default' ? [] : ['--project', project]), request.kind, ...request.fluids,
    ...list('--load', request.loads), ...list('--speed', request.kind === 'traction' ? request.speeds : RIGS[request.kind].swept),
    ...list('--srr', request.kind === 'traction' ? RIGS.traction.swept : request.slides), ...list('--temperature', request.temperatures),
    '--radius', `${request.radius}mm`, '--disc', request.disc,
    ...(request.surface === usual.surface ? [] : ['--surface', request.surface || 'smooth']),
    ...(request.roughness === (request.surface === usual.surface ? usual.roughness : 0) ? [] : ['--roughness', `${request.roughness}nm`]),
    ...modelFlagsOf(request),
    ...(request.hasBands ? [] : ['--draws', '0']),
  ].join(' ')];
}
