import type { OperatingPointStudy } from './api/types';

export const PHASE = 'mesh_phase_cycles';
export const ERROR = 'dynamic_transmission_error_metres';
export const VELOCITY = 'dynamic_transmission_error_velocity_metres_per_second';
const COLUMNS = [
  PHASE, ERROR, VELOCITY, 'mesh_force_newtons', 'pinion_friction_torque_newton_metres',
  'flank_load_newtons', 'flank_film_ratio', 'flank_contact_temperature_kelvin',
];
export const MESH_CYCLES = 2;
const SAMPLES_PER_MESH_CYCLE = 960; // many divisors: buckets of envelopes end with the mesh cycle

/** What is computed of a point that is opened: all that its page shows. */
export const studyOf = (condition: OperatingPointStudy): OperatingPointStudy => ({
  ...condition, sensitivities: true,
  history: { columns: COLUMNS, mesh_cycles: MESH_CYCLES, samples_per_mesh_cycle: SAMPLES_PER_MESH_CYCLE },
});
