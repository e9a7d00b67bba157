import { kelvin, metres, plain, watts, type Unit } from './units';

/** A quantity of a curve and the columns of the answer that show it. */
export interface Quantity {
  id: string; // in addresses
  label: string; // on buttons and small plots
  title: string; // of a plot
  columns: string[]; // one line each
  unit: Unit;
  level?: { value: number; label: string }; // a line across the plot, in the shown unit
  fromZero?: boolean;
}

export const QUANTITIES: Quantity[] = [
  { id: 'inefficiency', label: 'Inefficiency', title: 'Mesh inefficiency, % of the power that comes in',
    columns: ['inefficiency_energy_mean_percent'], unit: plain('%') },
  { id: 'loss', label: 'Loss', title: 'Mesh loss', columns: ['mesh_loss_power_watts'], unit: watts, fromZero: true },
  { id: 'film', label: 'Film ratio', title: 'Least film ratio over the mesh cycle',
    columns: ['minimum_film_ratio'], unit: plain(''), level: { value: 1, label: 'film as high as the roughness' }, fromZero: true },
  { id: 'temperature', label: 'Temperature', title: 'Hottest contact over the mesh cycle',
    columns: ['maximum_contact_temperature_kelvin'], unit: kelvin },
  { id: 'torque', label: 'Friction torque', title: 'Mean friction torque on the pinion',
    columns: ['mean_pinion_friction_torque_newton_metres'], unit: plain('N m') },
  { id: 'dte', label: 'Transmission error', title: 'Dynamic transmission error, least and greatest',
    columns: ['minimum_dynamic_transmission_error_metres', 'maximum_dynamic_transmission_error_metres'],
    unit: metres },
  { id: 'boundary', label: 'Boundary friction', title: 'Boundary over viscous friction force (RMS)',
    columns: ['boundary_to_viscous_friction_ratio'], unit: plain(''), fromZero: true },
  { id: 'boundary-loss', label: 'Boundary loss', title: 'Loss by boundary friction',
    columns: ['boundary_loss_power_watts'], unit: watts, fromZero: true },
];

export const quantityOf = (id: string | null): Quantity =>
  QUANTITIES.find((each) => each.id === id) ?? QUANTITIES[0]!;

/** Columns that every plot of a curve needs. */
export const CURVE_COLUMNS = [
  'speed_kilometres_per_hour', 'contact_loss', 'estimated_relative_error', 'mean_pinion_speed_radians_per_second', 'pinion_torque_newton_metres',
  ...QUANTITIES.flatMap((each) => each.columns),
];
