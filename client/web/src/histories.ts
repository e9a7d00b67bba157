/** What is kept of a point that is opened from a curve. */
export const PHASE = 'mesh_phase_cycles';
export const HISTORY_COLUMNS = [
  PHASE, 'dynamic_transmission_error_metres', 'mesh_force_newtons', 'pinion_friction_torque_newton_metres',
  'flank_load_newtons', 'flank_film_ratio', 'flank_contact_temperature_kelvin',
];
export const MESH_CYCLES = 2;
export const SAMPLES_PER_MESH_CYCLE = 960; // many divisors: buckets of envelopes end with the mesh cycle
