import { useMemo } from 'preact/hooks';
import type { ComparedPoint, ComparePointsRequest, ComparePointsResponse, Simulation, UncertainFigure } from './api/types';
import { change, url } from './api/client';
import type { Line, Spec } from './charts/spec';
import { differenceSpec } from './comparison';
import { finite, isUncertain } from './components/num';
import { axisLabelOf, axisOf, shortTitle, variantOf, type Curve } from './curve';
import { idOf, revisionIdOf } from './format';
import { shown, type Unit } from './units';
import { inputsOf } from './request';
import { useLoaded, type Loaded } from './resources';

// Limits of ComparePoints.
const MOST_LUBRICANTS = 8;
const MOST_POINTS = 10_000;
/** Curves on a plot whose uncertainty is asked for: more of them have thin lines, which bands would hide. */
const MOST_CURVES = 12;
const LEAST_DRAWS = 19;
const USUAL_DRAWS = 199;

/** Curves at the same conditions by the same model, whose fluids the service compares. */
export interface Group {
  curves: Curve[]; // the reference first
  body: ComparePointsRequest;
}

export interface ComparedGroup extends Group {
  answer: ComparePointsResponse;
}

/** Groups of curves with the requests that give their uncertainties and differences. */
export function groupsOf(curves: Curve[], reference: string, withContact: boolean): Group[] {
  const groups = new Map<string, Curve[]>();
  for (const curve of curves) {
    const { lubricant, ...inputs } = inputsOf(curve.simulation);
    const key = JSON.stringify([inputs, curve.columns['speed_kilometres_per_hour'], curve.simulation.inefficiency_curve?.ascent_angle_degrees]);
    const group = groups.get(key) ?? [];
    if (!group.some((each) => each.simulation.lubricant_revision === lubricant)) group.push(curve);
    groups.set(key, group);
  }
  return [...groups.values()].flatMap((all) => {
    const first = all.findIndex((each) => idOf(each.simulation.lubricant_revision) === reference);
    const group = (first > 0 ? [all[first]!, ...all.filter((_, k) => k !== first)] : all).slice(0, MOST_LUBRICANTS);
    const { simulation, columns } = group[0]!;
    const speeds = columns['speed_kilometres_per_hour'] as number[];
    const draws = Math.min(USUAL_DRAWS, Math.floor(MOST_POINTS / (group.length * speeds.length)) - 1);
    if (draws < LEAST_DRAWS) return [];
    const { lubricant: _, sump_temperature_celsius, inlet_temperature_rise_kelvin, solver_options: __, ...inputs } = inputsOf(simulation);
    return [{
      curves: group,
      body: {
        ...inputs,
        lubricants: group.map((each) => each.simulation.lubricant_revision!),
        conditions: speeds.map((speed) => ({
          speed_kilometres_per_hour: speed, sump_temperature_celsius, inlet_temperature_rise_kelvin,
          ascent_angle_degrees: simulation.inefficiency_curve?.ascent_angle_degrees ?? 0,
        })),
        draws, contact_figures: withContact,
      },
    }];
  });
}

/** Requests the uncertainties of curves, group by group. */
export function useUncertainty(curves: Curve[], reference: string, withContact: boolean, isOn: boolean): Loaded<ComparedGroup[]> {
  const groups = useMemo(() => (isOn && curves.length <= MOST_CURVES ? groupsOf(curves, reference, withContact) : []), [curves, reference, withContact, isOn]);
  return useLoaded((signal) => Promise.all(groups.map(async (group) =>
    ({ ...group, answer: await change<ComparePointsResponse>('POST', url('points:compare'), group.body, signal) }))),
  JSON.stringify(groups.map((each) => each.body)));
}

const FIGURES: Record<string, (point: ComparedPoint) => UncertainFigure | undefined> = {
  inefficiency_energy_mean_percent: (point) => point.inefficiency_energy_mean_percent,
  mesh_loss_power_watts: (point) => point.mesh_loss_power_watts,
  minimum_film_ratio: (point) => point.film_ratio_minimum,
  maximum_contact_temperature_kelvin: (point) => point.contact_temperature_maximum_kelvin,
  minimum_dynamic_transmission_error_metres: (point) => point.dynamic_transmission_error_minimum_metres,
  maximum_dynamic_transmission_error_metres: (point) => point.dynamic_transmission_error_maximum_metres,
};
export const needsContactFigures = (columns: string[]): boolean =>
  columns.some((each) => each === 'minimum_film_ratio' || each === 'maximum_contact_temperature_kelvin');

/** The revisions of fluids of which nobody stated an uncertainty: their figures have no interval. */
export const unstatedOf = (groups: ComparedGroup[] | undefined): string[] =>
  [...new Set((groups ?? []).flatMap((group) => (group.answer.lubricants ?? []).filter((each) => !each.uncertainty_stated).map((each) => each.lubricant_revision!)))];

/** The figure of a column of a curve at one of its rows, with its uncertainty if one is stated. */
export function figureOf(groups: ComparedGroup[] | undefined, simulation: Simulation, column: string, row: number): UncertainFigure | undefined {
  const read = FIGURES[column];
  if (!read) return undefined;
  for (const group of groups ?? []) {
    const k = group.curves.findIndex((each) => each.simulation.name === simulation.name);
    const fluid = k < 0 ? undefined : group.answer.lubricants?.[k];
    const point = fluid?.points?.[row];
    if (point && !point.refusal_reason) return fluid!.uncertainty_stated ? read(point) : { solver_error: read(point)?.solver_error };
  }
  return undefined;
}

/** Adds the intervals of the service to the line of a column. */
export function withIntervals(line: Line, curve: Curve, column: string, unit: Unit, groups: ComparedGroup[] | undefined): Line {
  const rows = new Map(axisOf(curve).map((speed, row) => [speed, row]));
  let hasOne = false;
  const edge = (read: (figure: UncertainFigure) => number | undefined) => line.x.map((speed, i) => {
    const row = rows.get(speed);
    const figure = row === undefined || line.y[i] === null ? undefined : figureOf(groups, curve.simulation, column, row);
    const value = figure && isUncertain(figure) ? finite(read(figure)) : null;
    if (value !== null) hasOne = true;
    return value === null ? null : shown(value, unit);
  });
  const low = edge((figure) => figure.interval_minimum);
  const high = edge((figure) => figure.interval_maximum);
  return hasOne ? { ...line, low, high } : line;
}

/** Differences of all groups from their first fluids, on one plot; null if no group has two fluids. */
export function differencesOf(groups: ComparedGroup[] | undefined, fluids: string[], titles: Map<string, string>): Spec | null {
  const wide = (groups ?? []).filter((each) => each.curves.length > 1);
  if (wide.length === 0) return null;
  const simulations = wide.map((each) => each.curves[0]!.simulation);
  const specs = wide.map((group, k) => {
    const revisions = group.curves.map((each) => each.simulation.lubricant_revision!);
    const names = revisions.map((each) => shortTitle(titles.get(idOf(each)) ?? revisionIdOf(each)));
    const variant = variantOf(simulations[k]!, simulations);
    const spec = differenceSpec(group.answer.lubricants ?? [], names, axisOf(group.curves[0]!),
      revisions.map((each) => fluids.indexOf(each)), axisLabelOf(group.curves[0]));
    spec.lines.forEach((line) => {
      line.variant = k;
      if (variant !== '') line.label += `, ${variant}`;
      if (line.low?.every((low) => low === null)) delete line.low;
    });
    return spec;
  });
  return { ...specs[0]!, lines: specs.flatMap((each) => each.lines) };
}

/** Adds the intervals of the service to all lines of a quantity. */
export function specWithIntervals(spec: Spec, curves: Curve[], columns: string[], unit: Unit, groups: ComparedGroup[] | undefined): Spec {
  if (!groups || groups.length === 0) return spec;
  return {
    ...spec,
    lines: spec.lines.map((line, i) =>
      (line.to ? line : withIntervals(line, curves[Math.floor(i / columns.length)]!, columns[i % columns.length]!, unit, groups))),
  };
}
