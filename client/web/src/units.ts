import { Store } from './store';

/** A unit in which a quantity is shown: value * factor + offset. */
export interface Unit {
  readonly symbol: string;
  readonly factor: number;
  readonly offset: number;
}

export const plain = (symbol: string): Unit => ({ symbol, factor: 1, offset: 0 });
export const scaled = (symbol: string, factor: number): Unit => ({ symbol, factor, offset: 0 });

/** Quantities that the field writes in several units, the usual one first. Only constants stand here. */
export const UNIT_CHOICES = {
  temperature: { label: 'Temperature', units: [{ symbol: '°C', factor: 1, offset: -273.15 }, plain('K')] },
  length: { label: 'Film, transmission error', units: [scaled('µm', 1e6), scaled('nm', 1e9)] },
  power: { label: 'Loss', units: [plain('W'), scaled('kW', 1e-3)] },
  pressure: { label: 'Pressure', units: [scaled('GPa', 1e-9), scaled('MPa', 1e-6)] },
  pressureCoefficient: { label: 'Pressure-viscosity coefficient', units: [scaled('1/GPa', 1e9), scaled('mm²/N', 1e6)] },
  speed: { label: 'Speed of curves', units: [plain('km/h'), scaled('rpm', 30 / Math.PI)] },
  viscosity: { label: 'Viscosity', units: [plain('mm²/s'), plain('mPa s')] },
} satisfies Record<string, { label: string; units: Unit[] }>;
export type UnitKind = keyof typeof UNIT_CHOICES;

const KEY = 'units';

function stored(): Partial<Record<UnitKind, string>> {
  try {
    return JSON.parse(localStorage.getItem(KEY) ?? '{}');
  } catch {
    return {};
  }
}

/** Symbols of the chosen units; what is missing is shown in its usual unit. */
export const units = new Store<Partial<Record<UnitKind, string>>>(stored());
units.subscribe(() => localStorage.setItem(KEY, JSON.stringify(units.value)));

const inUse = (kind: UnitKind): Unit => {
  const all: Unit[] = UNIT_CHOICES[kind].units;
  return all.find((each) => each.symbol === units.value[kind]) ?? all[0]!;
};

/** The unit that is chosen for a kind of quantity, whenever it is read. */
const chosen = (kind: UnitKind): Unit => ({
  get symbol() { return inUse(kind).symbol; },
  get factor() { return inUse(kind).factor; },
  get offset() { return inUse(kind).offset; },
});
export const kelvin = chosen('temperature'); // of values in K
export const metres = chosen('length'); // of values in m
export const watts = chosen('power'); // of values in W
export const pascals = chosen('pressure'); // of values in Pa
export const perPascal = chosen('pressureCoefficient'); // of values in 1/Pa

/** The unit of values in degrees Celsius. */
export const celsius: Unit = {
  get symbol() { return inUse('temperature').symbol; },
  factor: 1,
  get offset() { return inUse('temperature').symbol === 'K' ? 273.15 : 0; },
};

/** Whether speeds are those of the pinion, in rpm. */
export const isInRpm = (): boolean => inUse('speed').symbol === 'rpm';
export const RPM: Unit = UNIT_CHOICES.speed.units[1]!; // of values in rad/s
/** Whether viscosities are dynamic ones. */
export const isDynamic = (): boolean => inUse('viscosity').symbol === 'mPa s';

export const shown = (value: number, unit: Unit): number => value * unit.factor + unit.offset;

const WRITTEN_FIGURES = 12; // fewer than a double has: a sum or a product leaves no 40.000000000000057

/** A number as people write it, with all digits that it has in this unit. */
export const written = (value: number | undefined, unit: Unit): string =>
  value === undefined ? '' : String(Number(shown(value, unit).toPrecision(WRITTEN_FIGURES)));

/** The number that a text states; NaN if it states none. */
export const readNumber = (text: string, unit: Unit): number => {
  const number = text.trim() === '' ? NaN : Number(text.trim().replace(',', '.'));
  return unit.offset === 0 ? Number((number / unit.factor).toPrecision(15))
    : Number(((number - unit.offset) / unit.factor).toPrecision(WRITTEN_FIGURES));
};

const USUAL_SUMP_CELSIUS = 40; // of the service

/** The temperature of a sump, e.g. "90 °C". */
export const sumpText = (degreesCelsius: number | undefined): string => `${written(degreesCelsius ?? USUAL_SUMP_CELSIUS, celsius)} ${celsius.symbol}`;
