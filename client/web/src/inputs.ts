// Words and units of the inputs of the model: by the fields of an oil and the schema of the service.
import type { Constraint } from './api/types';
import { ALL_FIELDS, symbolOf } from './lubricant_fields';
import { celsius, metres, pascals, perPascal, plain, scaled, watts, type Unit } from './units';

const SHOWN: Record<string, Unit> = {
  Pa: pascals, '1/Pa': perPascal, 'Pa s': scaled('mPa s', 1e3), s: scaled('µs', 1e6), m: metres, W: watts, C: celsius,
};
/** The unit in which values in a unit of the service are shown. */
export const shownUnit = (unit: string): Unit => SHOWN[unit] ?? plain(symbolOf(unit));

const MESSAGES: Record<string, string[]> = {
  lubricant: ['Lubricant', 'ImprovedYasutomi'], surface: ['Surface'], gear_set: ['GearSet'], vehicle: ['Vehicle'],
};
const CONDITIONS = ['PointCondition', 'RigCondition'];

/** The row of the schema of an input: a parameter such as "lubricant.relaxation_time_seconds", or a condition. */
export function constraintAt(path: string, constraints: Constraint[] | undefined): Constraint | undefined {
  const [owner, ...names] = path.split('.');
  const messages = names.length === 0 ? CONDITIONS : MESSAGES[owner!] ?? [];
  return constraints?.find((each) => each.field === (names.at(-1) ?? owner) && messages.includes(each.message!));
}

const USUAL_UNITS = new Map<string, Unit>(ALL_FIELDS.flatMap((each) => (each.unit ? [[`lubricant.${each.path}`, each.unit] as const] : [])));
/** The unit in which an input is shown. */
export const inputUnit = (path: string, constraints: Constraint[] | undefined): Unit =>
  USUAL_UNITS.get(path) ?? shownUnit(constraintAt(path, constraints)?.unit ?? '');

const LABELS: [string, string][] = [
  ...ALL_FIELDS.map((each): [string, string] => [`lubricant.${each.path}`, each.label]),
  ['lubricant.density_temperature_slope', 'Slope of the density'],
  ...['surface', 'roughness'].flatMap((owner): [string, string][] => [
    [`${owner}.asperity_density_per_square_metre`, 'Asperity density η'], [`${owner}.asperity_radius_metres`, 'Asperity radius β'],
    [`${owner}.composite_rms_height_metres`, 'Roughness σ'], [`${owner}.tribofilm_shear_strength_pascals`, 'Tribofilm shear strength'],
    [`${owner}.asperity_friction_coefficient`, 'Asperity friction coefficient'],
  ]),
  ...['gear_set', 'solid'].flatMap((owner): [string, string][] => {
    const solid = owner === 'gear_set' ? 'solid_' : '';
    return [
      [`${owner}.youngs_modulus_pascals`, "Young's modulus of the flanks"], [`${owner}.poissons_ratio`, "Poisson's ratio of the flanks"],
      [`${owner}.${solid}thermal_conductivity_watts_per_metre_kelvin`, 'Thermal conductivity of the flanks'],
      [`${owner}.${solid}density_kilograms_per_cubic_metre`, 'Density of the flanks'],
      [`${owner}.${solid}specific_heat_capacity_joules_per_kilogram_kelvin`, 'Heat capacity of the flanks'],
    ];
  }),
  ['sump_temperature_celsius', 'Sump temperature'], ['inlet_temperature_rise_kelvin', 'Rise from the sump to the inlet'],
];
const LABEL_OF = new Map(LABELS);

/** The label of a field; sensitivities name it without its unit. */
const labelOf = (field: string): string | undefined => LABEL_OF.get(field) ?? LABELS.find(([name]) => name.startsWith(`${field}_`))?.[1];

/** "Pressure-viscosity coefficient α*" of "lubricant.pressure_viscosity_coefficient_per_pascal". */
export function inputWords(input: string): string {
  if (/vogel_viscosity_prefactor.*vogel_temperature_coefficient/.test(input)) return 'Viscosity and its temperature law';
  return input.split(' ').map((field) => {
    const known = labelOf(field);
    if (known) return known;
    const words = field.replace(/^\w+\./, '').replace(/[_.]/g, ' ');
    return words.charAt(0).toUpperCase() + words.slice(1);
  }).join(', ');
}
