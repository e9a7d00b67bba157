/** Figures of points with names for people, in the order in which they are shown. */
export const FIGURES: Record<string, string> = {
  inefficiency_energy_mean_percent: 'Mesh inefficiency',
  mesh_loss_power_watts: 'Mesh loss',
  film_ratio_minimum: 'Least film ratio',
  contact_temperature_maximum_kelvin: 'Hottest contact',
  maximum_pressure_maximum_pascals: 'Greatest pressure',
  mean_friction_coefficient: 'Friction coefficient of the mesh',
  viscous_loss_power_watts: 'Viscous loss',
  boundary_loss_power_watts: 'Boundary loss',
  pinion_torque_newton_metres: 'Pinion torque',
  wheel_torque_newton_metres: 'Wheel torque',
  dynamic_transmission_error_minimum_metres: 'Least transmission error',
  dynamic_transmission_error_maximum_metres: 'Greatest transmission error',
  contact_loss: 'Flanks separate (1)',
  inefficiency_rms_percent: 'Mesh inefficiency, RMS',
  estimated_relative_error: 'Solver error, relative',
};

const UNITS = /_(percent|pascals?|seconds?|kelvin|celsius|metres?|newtons?|newton_metres|watts|hertz|per_\w+|radians\w*)\b/;
const EXTREMES: Record<string, string> = { minimum: 'least', mean: 'mean', maximum: 'greatest' };

/** "Film ratio, least" of "film_ratio.minimum". */
export function figureWords(name: string): string {
  if (FIGURES[name]) return FIGURES[name]!;
  const [figure, extreme] = name.split('.');
  const words = figure!.replace(UNITS, '').replaceAll('_', ' ');
  return words.charAt(0).toUpperCase() + words.slice(1) + (extreme ? `, ${EXTREMES[extreme] ?? extreme}` : '');
}
