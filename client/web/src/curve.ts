import { get, url } from './api/client';
import type { BranchEnd, RangeWarning, Simulation } from './api/types';
import { idOf, revisionIdOf, rounded } from './format';
import { modelOf, optionWords, type Preset } from './model';
import { isInRpm, plain, RPM, scaled, shown, sumpText, type Unit } from './units';
import { CURVE_COLUMNS, QUANTITIES, type Quantity } from './quantities';
import type { Line, Spec } from './charts/spec';
import { levelOf, remarkOf, runsText, type Remark } from './validity';

/** A curve as the service answers it. */
export interface Curve {
  simulation: Simulation;
  columns: Record<string, (number | null)[]>; // a row for each speed
  warnings: RangeWarning[][];
  branchEnds: (BranchEnd | undefined)[];
  refusals: { speed: number; message: string }[];
}

/** Fields of a simulation that say what was asked and how it went, without its numbers. */
export const INPUT_FIELDS =
  'name,display_name,lubricant,gear_set,surface,vehicle,sump_temperature_celsius,inlet_temperature_rise_kelvin,model_options,' +
  'solver_options,operating_point,inefficiency_curve,labels,state,progress_fraction,create_time,start_time,end_time,error,' +
  'lubricant_revision,gear_set_revision,surface_revision,vehicle_revision,input_hash,cache_hit,pinned';

const POINT_FIELDS =
  'result.points.speed_kilometres_per_hour,result.points.branch_end,result.points.refusal_reason,' +
  'result.points.refusal_message,result.points.result.warnings,result.model_version,result.platform,' +
  'result.input_warnings,result.direction';

export async function readSimulation(name: string, fields = INPUT_FIELDS): Promise<Simulation> {
  return get<Simulation>(url(name, { read_mask: fields }));
}

export async function readCurve(name: string): Promise<Curve> {
  const [simulation, table] = await Promise.all([
    readSimulation(name, `${INPUT_FIELDS},${POINT_FIELDS}`),
    get<{ columns: Record<string, (number | null)[]> }>(url(name, { alt: 'columns', columns: CURVE_COLUMNS.join(',') })),
  ]);
  const points = simulation.result?.points ?? [];
  return {
    simulation,
    columns: table.columns,
    warnings: points.map((point) => point.result?.warnings ?? []),
    branchEnds: points.map((point) => point.branch_end),
    refusals: points.flatMap((point) =>
      point.refusal_reason ? [{ speed: point.speed_kilometres_per_hour!, message: point.refusal_message ?? '' }] : []),
  };
}

/** The name of a fluid before its remark: "Lubricant 1" of "Lubricant 1: ester-olefin copolymer". */
export const shortTitle = (title: string): string => title.split(': ')[0]!;

/** What the model of a curve leaves out of its preset, or adds. */
export const optionsOf = (simulation: Simulation): string[] => modelOf(simulation.model_options).options;
const presetOf = (simulation: Simulation): Preset => modelOf(simulation.model_options).preset;

/** What differs between curves of one fluid: sump, gear set, model, direction of the speed. */
export function variantOf(simulation: Simulation, all: Simulation[]): string {
  const differs = (key: (each: Simulation) => string) => new Set(all.map(key)).size > 1;
  const sump = (each: Simulation) => sumpText(each.sump_temperature_celsius);
  const gears = (each: Simulation) => idOf(each.gear_set_revision);
  const preset = (each: Simulation) => (presetOf(each) === 'PAPER' ? 'model of the paper' : 'recommended model');
  const model = (each: Simulation) => optionWords(optionsOf(each)) || 'full model';
  const sweep = (each: Simulation) => (each.inefficiency_curve?.direction === 'SWEEP_DIRECTION_DOWN' ? 'falling speed' : 'rising speed');
  return [sump, gears, preset, model, sweep].filter(differs).map((key) => key(simulation)).join(', ');
}

/** The unit of the axis of speeds of a curve: those of its pinion are proportional to those of the vehicle. */
export function speedUnitOf(curve: Curve | undefined): Unit {
  if (!curve || !isInRpm()) return plain('km/h');
  const pinion = curve.columns['mean_pinion_speed_radians_per_second']!;
  const row = pinion.findIndex((value) => value !== null);
  return row < 0 ? plain('km/h') : scaled(RPM.symbol, (RPM.factor * pinion[row]!) / curve.columns['speed_kilometres_per_hour']![row]!);
}

/** The speeds of a curve as its axis shows them. */
export const axisOf = (curve: Curve): number[] => {
  const unit = speedUnitOf(curve);
  return (curve.columns['speed_kilometres_per_hour'] as number[]).map((speed) => shown(speed, unit));
};

/** The speed [km/h] of a curve that is nearest to a place on the axis. */
export function speedNear(curves: Curve[], place: number): number | null {
  let best: number | null = null;
  let least = Infinity;
  for (const curve of curves) {
    axisOf(curve).forEach((x, row) => {
      if (Math.abs(x - place) < least) [best, least] = [curve.columns['speed_kilometres_per_hour']![row]!, Math.abs(x - place)];
    });
  }
  return best;
}

export const axisLabelOf = (curve: Curve | undefined): string =>
  (speedUnitOf(curve).symbol === RPM.symbol ? 'Mean speed of the pinion, rpm' : 'Vehicle speed, km/h');

/** Speeds with a property, as bands that reach half-way to the neighbours. */
export function bandsOf(curves: Curve[], has: (curve: Curve, row: number) => boolean): [number, number][] {
  const bands: [number, number][] = [];
  for (const curve of curves) {
    const speeds = axisOf(curve);
    speeds.forEach((speed, row) => {
      if (!has(curve, row)) return;
      const before = row > 0 ? (speed + speeds[row - 1]!) / 2 : speed;
      const after = row + 1 < speeds.length ? (speed + speeds[row + 1]!) / 2 : speed;
      bands.push([before, after]);
    });
  }
  bands.sort((a, b) => a[0] - b[0]);
  const merged: [number, number][] = [];
  for (const band of bands) {
    const last = merged.at(-1);
    if (last && band[0] <= last[1] + 1e-9) last[1] = Math.max(last[1], band[1]);
    else merged.push([...band]);
  }
  return merged;
}

function lineOf(curve: Curve, quantity: Quantity, column: string, label: string, series: number, variant: number): Line {
  const speeds = axisOf(curve);
  const line: Line = { label, series, variant, x: [], y: [], hollow: [], error: [] };
  const isDown = curve.simulation.result?.direction === 'SWEEP_DIRECTION_DOWN';
  speeds.forEach((speed, row) => {
    const end = curve.branchEnds[row];
    const gap = () => {
      line.x.push(shown(end!.followed_to_kilometres_per_hour!, speedUnitOf(curve)));
      line.y.push(null);
      line.hollow.push(false);
      line.error!.push(null);
    };
    if (end && !isDown) gap();
    const value = curve.columns[column]![row] ?? null;
    const relative = curve.columns['estimated_relative_error']![row];
    line.x.push(speed);
    line.y.push(value === null ? null : shown(value, quantity.unit));
    line.hollow.push(curve.columns['contact_loss']![row] === 1);
    // Only lengths on the screen are made of this product.
    line.error!.push(value === null || relative == null ? null : Math.abs(value * relative * quantity.unit.factor));
    if (end && isDown) gap();
  });
  return line;
}

/** The fluids of curves in the order of their first curve; a fluid keeps its color. */
export function fluidsOf(curves: { simulation: Simulation }[]): string[] {
  return [...new Set(curves.map((curve) => curve.simulation.lubricant_revision ?? ''))];
}

/** Fills the area between curves of another model and those of the full model: the difference, drawn. */
function fillToBase(lines: Line[], curves: Curve[], columns: number): void {
  const scene = ({ simulation }: Curve) =>
    [simulation.lubricant_revision, simulation.gear_set_revision, simulation.sump_temperature_celsius ?? 40, presetOf(simulation)].join(' ');
  curves.forEach((curve, k) => {
    if (optionsOf(curve.simulation).length === 0) return;
    const base = curves.findIndex((each) => optionsOf(each.simulation).length === 0 && scene(each) === scene(curve));
    if (base < 0) return;
    for (let i = 0; i < columns; ++i) {
      const line = lines[k * columns + i]!;
      const other = lines[base * columns + i]!;
      const values = new Map(other.x.map((x, row) => [x, other.y[row] ?? null]));
      line.to = line.x.map((x, row) => (line.y[row] === null ? null : values.get(x) ?? null));
      line.opacity = 0.16;
    }
  });
}

/** The parts of the loss of one curve, stacked: boundary friction beneath viscous friction. */
export function splitSpecOf(curve: Curve, label: string, series: number, greatest: number, parted: Spec['parted'], outside: Spec['outside']): Spec {
  const unit = QUANTITIES.find((each) => each.id === 'loss')!.unit;
  const quantity = { ...QUANTITIES[0]!, unit };
  const boundary = lineOf(curve, quantity, 'boundary_loss_power_watts', '', series, 1);
  const total = lineOf(curve, quantity, 'mesh_loss_power_watts', '', series, 0);
  boundary.to = boundary.y.map((value) => (value === null ? null : 0));
  total.to = boundary.y;
  boundary.opacity = 0.55;
  total.opacity = 0.2;
  return {
    title: label, xLabel: axisLabelOf(curve), yLabel: unit.symbol, lines: [total, boundary], parted, caution: [], outside,
    levels: [], fromZero: true, yRange: [0, 1.07 * shown(greatest, unit)], hasErrors: false,
  };
}

export function specOf(curves: Curve[], quantity: Quantity, titles: Map<string, string>, halfBacklash?: number): Spec {
  const simulations = curves.map((curve) => curve.simulation);
  const fluids = fluidsOf(curves);
  const variants = [...new Set(simulations.map((each) => variantOf(each, simulations)))];
  const lines = curves.flatMap((curve) => {
    const revision = curve.simulation.lubricant_revision ?? '';
    const variant = variantOf(curve.simulation, simulations);
    const title = shortTitle(titles.get(idOf(revision)) || revisionIdOf(revision));
    const label = variant === '' ? title : `${title}, ${variant}`;
    return quantity.columns.map((column, k) =>
      lineOf(curve, quantity, column, k === 0 ? label : '', fluids.indexOf(revision), variants.indexOf(variant)));
  });
  fillToBase(lines, curves, quantity.columns.length);
  const levels = quantity.level ? [quantity.level] : [];
  if (quantity.id === 'dte' && halfBacklash !== undefined) {
    const value = shown(halfBacklash, quantity.unit);
    levels.push({ value, label: 'half backlash' }, { value: -value, label: 'half backlash, coast side' });
  }
  const has = (level: string) => (curve: Curve, row: number) =>
    curve.warnings[row]!.some((warning) => levelOf(warning) === level);
  return {
    title: quantity.title,
    xLabel: axisLabelOf(curves[0]),
    yLabel: quantity.unit.symbol,
    lines,
    parted: bandsOf(curves, (curve, row) => curve.columns['contact_loss']![row] === 1),
    caution: bandsOf(curves, has('caution')),
    outside: bandsOf(curves, has('outside')),
    levels,
    fromZero: quantity.fromZero ?? false,
  };
}

/** "20 to 70, 80 km/h": the speeds at which a row of any curve has a property. */
function speedsText(curves: Curve[], has: (curve: Curve, row: number) => boolean): string {
  const all = new Set<number>();
  const affected = new Set<number>();
  for (const curve of curves) {
    (curve.columns['speed_kilometres_per_hour'] as number[]).forEach((speed, row) => {
      all.add(speed);
      if (has(curve, row)) affected.add(speed);
    });
  }
  const unit = speedUnitOf(curves[0]);
  const runs = runsText([...all].sort((a, b) => a - b), (speed) => affected.has(speed), (speed) => (unit.factor === 1 ? `${speed}` : rounded(shown(speed, unit), 1)));
  return runs === '' ? 'all speeds' : `${runs} ${unit.symbol}`;
}

/** Warnings of all points and inputs, each once, with the speeds that it holds for. */
export function remarksOf(curves: Curve[]): Remark[] {
  const warnings = new Map<string, RangeWarning>();
  for (const warning of curves.flatMap((curve) => curve.warnings.flat())) {
    if (!warnings.has(warning.code!)) warnings.set(warning.code!, warning);
  }
  const inputs = new Map(curves.flatMap((curve) => (curve.simulation.result?.input_warnings ?? []).map((each) => [`${each.code} ${each.message}`, each] as const)));
  return [
    ...[...warnings].map(([code, warning]) =>
      remarkOf(warning, speedsText(curves, (curve, row) => curve.warnings[row]!.some((each) => each.code === code)))),
    ...[...inputs.values()].map((each) => remarkOf(each)),
  ];
}
