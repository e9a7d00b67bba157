import type { Constraint, Lubricant } from './api/types';
import { kelvin, perPascal, plain, scaled, shown, written, type Unit } from './units';

/** A number of a lubricant that the form shows; the range comes from the schema. */
export interface Field {
  path: string; // within Lubricant, as violations name it
  message: 'Lubricant' | 'LubricantMeasurements' | 'ImprovedYasutomi';
  field: string;
  label: string;
  unit?: Unit; // in which people write it; else the schema's
}

const measured = (field: string, label: string): Field =>
  ({ path: `measurements.${field}`, message: 'LubricantMeasurements', field, label });
const parameter = (field: string, label: string, unit?: Unit): Field =>
  ({ path: field, message: 'Lubricant', field, label, ...(unit ? { unit } : {}) });

export const DATA_SHEET: Field[] = [
  measured('kinematic_viscosity_40_celsius_square_millimetres_per_second', 'Viscosity at 40 °C'),
  measured('kinematic_viscosity_100_celsius_square_millimetres_per_second', 'Viscosity at 100 °C'),
  measured('density_15_celsius_kilograms_per_cubic_metre', 'Density at 15 °C'),
  measured('sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second', 'After shear, at 100 °C'),
];

/** The boundary friction that additives bring to any surface; empty: that of the surface. */
export const BOUNDARY: Field[] = [
  parameter('asperity_friction_coefficient', 'Boundary friction coefficient ζ'),
  parameter('tribofilm_shear_strength_pascals', 'Shear strength of the tribofilm', scaled('MPa', 1e-6)),
];

export const PARAMETERS: Field[] = [
  parameter('pressure_viscosity_coefficient_per_pascal', 'Pressure-viscosity coefficient α*', perPascal),
  parameter('pressure_viscosity_temperature_kelvin', 'Temperature of α*', kelvin),
  parameter('vogel_viscosity_prefactor_pascal_seconds', 'Vogel prefactor', scaled('mPa s', 1e3)),
  parameter('vogel_temperature_coefficient_kelvin', 'Vogel coefficient A₁'),
  parameter('vogel_reference_temperature_kelvin', 'Vogel reference temperature'),
  parameter('relaxation_time_seconds', 'Relaxation time', scaled('µs', 1e6)),
  parameter('havriliak_negami_alpha', 'Havriliak-Negami α'),
  parameter('havriliak_negami_beta', 'Havriliak-Negami β'),
  parameter('rheology_reference_temperature_kelvin', 'Reference temperature of rheology', kelvin),
  parameter('limiting_shear_stress_at_zero_pressure_pascals', 'Limiting shear stress at zero pressure', scaled('MPa', 1e-6)),
  parameter('limiting_shear_stress_coefficient', 'Limiting shear stress coefficient'),
  parameter('thermal_conductivity_watts_per_metre_kelvin', 'Thermal conductivity'),
  parameter('density_at_zero_kelvin_kilograms_per_cubic_metre', 'Density at 0 K'),
  parameter('density_slope_kilograms_per_cubic_metre_kelvin', 'Slope of the density'),
];

/** Limits of data sheets: below its pour point an oil is refused; the model does not use the flash point. */
export const DOCUMENTED: Field[] = [
  parameter('flash_point_celsius', 'Flash point'),
  parameter('pour_point_celsius', 'Pour point'),
];

const yasutomi = (field: string, label: string, unit?: Unit): Field =>
  ({ path: `improved_yasutomi.${field}`, message: 'ImprovedYasutomi', field, label, ...(unit ? { unit } : {}) });

/** The law of a fluid whose viscosity was measured under pressure; it takes the place of α*. */
export const PRESSURE_LAW: Field[] = [
  yasutomi('glass_viscosity_pascal_seconds', 'Yasutomi: viscosity at the glass transition'),
  yasutomi('glass_temperature_rise_kelvin', 'Yasutomi A₁, rise of the glass temperature'),
  yasutomi('glass_pressure_factor_per_pascal', 'Yasutomi A₂', perPascal),
  yasutomi('expansivity_pressure_factor_per_pascal', 'Yasutomi b₁', perPascal),
  yasutomi('expansivity_exponent', 'Yasutomi b₂'),
];

/** All numbers of a lubricant that pages show. */
export const ALL_FIELDS: Field[] = [...DATA_SHEET, ...DOCUMENTED, ...BOUNDARY, ...PARAMETERS, ...PRESSURE_LAW];

export const BASE_OILS: [string, string][] = [
  ['BASE_OIL_CLASS_UNSPECIFIED', 'not stated'],
  ['BASE_OIL_CLASS_GROUP_I', 'Group I'],
  ['BASE_OIL_CLASS_GROUP_II', 'Group II'],
  ['BASE_OIL_CLASS_GROUP_III', 'Group III'],
  ['BASE_OIL_CLASS_POLYALPHAOLEFIN', 'Polyalphaolefin (group IV)'],
  ['BASE_OIL_CLASS_ESTER', 'Ester (group V)'],
  ['BASE_OIL_CLASS_POLYALKYLENE_GLYCOL', 'Polyalkylene glycol (group V)'],
  ['BASE_OIL_CLASS_NAPHTHENIC', 'Naphthenic (group V)'],
];

export function valueOf(lubricant: Lubricant, field: Field): number | undefined {
  const holder = { Lubricant: lubricant, LubricantMeasurements: lubricant.measurements, ImprovedYasutomi: lubricant.improved_yasutomi }[field.message];
  const value = (holder as Record<string, unknown> | undefined)?.[field.field];
  // In measurements 0 stands for "not stated".
  return typeof value === 'number' && !(field.message === 'LubricantMeasurements' && value === 0) ? value : undefined;
}

export const constraintOf = (field: Field, constraints: Constraint[] | undefined): Constraint | undefined =>
  constraints?.find((each) => each.message === field.message && each.field === field.field);

const UNITS: Record<string, string> = { C: '°C', degrees: '°', 'mm2/s': 'mm²/s', 'kg/m3': 'kg/m³', 'kg/(m3 K)': 'kg/(m³ K)', '1/m2': '1/m²' };
/** A unit of the service with raised digits. */
export const symbolOf = (unit: string): string => UNITS[unit] ?? unit;
export const unitOf = (field: Field, constraint: Constraint | undefined): Unit => field.unit ?? plain(symbolOf(constraint?.unit ?? ''));

const LEAST_POWER = 1e6; // from which on a limit is written as a power

export function rangeText(constraint: Constraint | undefined, unit: Unit): string {
  if (!constraint) return '';
  const grouped = (value: number) => (Math.abs(shown(value, unit)) >= LEAST_POWER ? Number(written(value, unit)).toExponential().replace('e+', 'e')
    : written(value, unit).replace(/^(-?)(\d{2,3})(\d{3})$/, '$1$2\u202f$3'));
  return `${grouped(constraint.minimum!)} to ${grouped(constraint.maximum!)}`;
}
