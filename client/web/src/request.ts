import type { InefficiencyCurveStudy, Simulation } from './api/types';
import { revisionIdOf } from './format';
import { modelBodyOf, modelFlagsOf, modelOf, modelQueryOf, modelRequestOf, type Model } from './model';

/** What the form of the curves holds. */
export interface CurveRequest extends Model {
  fluids: string[]; // ids, with or without "@revision"
  sumps: number[]; // [C]
  gearSet: string; // id; "": the reference axle
  first: number; // [km/h]
  last: number; // [km/h]
  step: number; // [km/h]
}

export const DEFAULTS: CurveRequest = { fluids: [], sumps: [40], gearSet: '', first: 20, last: 140, step: 5, preset: 'RECOMMENDED', options: [] };

const numbers = (text: string | null): number[] =>
  (text ?? '').split(',').filter((word) => word.trim() !== '').map(Number);

export function requestOf(query: URLSearchParams): CurveRequest {
  const number = (name: string, otherwise: number) => (query.has(name) ? Number(query.get(name)) : otherwise);
  return {
    fluids: (query.get('f') ?? '').split(',').filter((each) => each !== ''),
    sumps: query.has('sump') ? numbers(query.get('sump')) : DEFAULTS.sumps,
    gearSet: query.get('gear') ?? '',
    first: number('from', DEFAULTS.first),
    last: number('to', DEFAULTS.last),
    step: number('step', DEFAULTS.step),
    ...modelRequestOf(query),
  };
}

/** The settings of an address that opens the form with this request. */
export function queryOf(request: CurveRequest): Record<string, string | undefined> {
  const unless = (value: number, usual: number) => (value === usual ? undefined : String(value));
  return {
    f: request.fluids.join(','),
    sump: request.sumps.join(','),
    gear: request.gearSet || undefined,
    from: unless(request.first, DEFAULTS.first),
    to: unless(request.last, DEFAULTS.last),
    step: unless(request.step, DEFAULTS.step),
    ...modelQueryOf(request),
  };
}

/** The request that computed simulations, with their revisions. */
export function requestOfSimulations(simulations: Simulation[]): CurveRequest {
  const first = simulations[0]!;
  const study: InefficiencyCurveStudy = first.inefficiency_curve ?? {};
  return {
    fluids: [...new Set(simulations.map((each) => revisionIdOf(each.lubricant_revision)))],
    sumps: [...new Set(simulations.map((each) => each.sump_temperature_celsius ?? 40))],
    gearSet: revisionIdOf(first.gear_set_revision),
    first: study.first_speed_kilometres_per_hour ?? DEFAULTS.first,
    last: study.last_speed_kilometres_per_hour ?? DEFAULTS.last,
    step: study.speed_step_kilometres_per_hour ?? DEFAULTS.step,
    ...modelOf(first.model_options),
  };
}

/** The bodies of CreateSimulation: one for each fluid and sump. */
export function bodiesOf(request: CurveRequest): Simulation[] {
  return request.fluids.flatMap((fluid) =>
    request.sumps.map((sump) => ({
      lubricant: `lubricants/${fluid}`,
      ...(request.gearSet ? { gear_set: `gearSets/${request.gearSet}` } : {}),
      sump_temperature_celsius: sump,
      ...modelBodyOf(request),
      inefficiency_curve: {
        first_speed_kilometres_per_hour: request.first,
        last_speed_kilometres_per_hour: request.last,
        speed_step_kilometres_per_hour: request.step,
      },
    })));
}

/** The command that computes the same curves. */
export function commandsOf(request: CurveRequest, project: string): string[] {
  return request.sumps.map((sump) =>
    ['tribodyn', ...(project === 'default' ? [] : ['--project', project]), 'curve',
      '--lubricant', request.fluids.join(','), '--sump-temperature-celsius', String(sump),
      ...(request.gearSet ? ['--gear-set', request.gearSet] : []),
      '--first-speed-kilometres-per-hour', String(request.first),
      '--last-speed-kilometres-per-hour', String(request.last),
      '--speed-step-kilometres-per-hour', String(request.step),
      ...modelFlagsOf(request)].join(' '));
}

/** All inputs of a simulation but what it computes, with the revisions that it used. */
export function inputsOf(simulation: Simulation): Simulation {
  return {
    lubricant: simulation.lubricant_revision,
    gear_set: simulation.gear_set_revision,
    surface: simulation.surface_revision,
    vehicle: simulation.vehicle_revision,
    sump_temperature_celsius: simulation.sump_temperature_celsius,
    inlet_temperature_rise_kelvin: simulation.inlet_temperature_rise_kelvin,
    model_options: simulation.model_options,
    solver_options: simulation.solver_options,
  };
}
