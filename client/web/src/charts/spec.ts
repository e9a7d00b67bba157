/** What a plot shows, whatever paints it. Values are in the shown unit. */
export interface Line {
  label: string; // of the fluid and variant; "" repeats that of the line before
  series: number; // index of the fluid: color and marker
  variant: number; // dash
  x: number[];
  y: (number | null)[]; // null breaks the line
  hollow: boolean[]; // flanks separate here
  error?: (number | null)[]; // estimated by the solver, absolute
  low?: (number | null)[]; // lower end of the interval by the inputs, with `high`
  high?: (number | null)[];
  to?: (number | null)[]; // fills the area between the line and these values
  opacity?: number; // of the area
  isMarksOnly?: boolean; // without a line between the markers
}

export interface Spec {
  title: string;
  xLabel: string;
  yLabel: string;
  lines: Line[];
  parted: [number, number][]; // speeds at which flanks separate
  caution: [number, number][]; // speeds at which a law leaves its validated range
  outside: [number, number][]; // speeds at which fluids must not be ranked
  levels: { value: number; label: string }[];
  fromZero: boolean;
  hasMarkers?: boolean; // and labels at the lines; default: true
  xRange?: [number, number]; // default: all
  yRange?: [number, number]; // default: all values and levels
  xIsLogarithmic?: boolean;
  yIsLogarithmic?: boolean; // values are above 0
  hasErrors?: boolean; // whiskers of the solver's error; default: true
}

export type Marker = 'circle' | 'square' | 'triangle' | 'diamond' | 'inverted';
export const MARKERS: Marker[] = ['circle', 'square', 'triangle', 'diamond', 'inverted'];
export const DASHES: number[][] = [[], [6, 4], [2, 3], [9, 3, 2, 3]];

/** Colors of the light theme, in which figures are exported. */
export const LIGHT = {
  background: '#ffffff', text: '#1b1f23', muted: '#57606a', axis: '#69717a', grid: '#e4e6e8', parted: '#eceef0',
  caution: '#8a5a00', outside: '#b3261e',
  series: ['#0072b2', '#d55e00', '#009e73', '#b5508a', '#1b1f23'],
  other: '#9aa1a8',
};
export type Colors = typeof LIGHT;
export const DARK: Colors = {
  background: '#14181c', text: '#e8eaed', muted: '#a9b1b9', axis: '#8b949d', grid: '#2b3239', parted: '#20262c',
  caution: '#e0a93b', outside: '#ff8a80',
  series: ['#4ba3dd', '#f0803c', '#2fbf94', '#dd95c0', '#e8eaed'],
  other: '#6b747d',
};

/** Five fluids have a color and a marker each; further ones are thin and gray. */
export const colorOf = (series: number, colors: Colors): string => colors.series[series] ?? colors.other;
export const hasMarker = (series: number): boolean => series < MARKERS.length;

/** The corners of a marker around (0, 0), or null for a circle. */
export function corners(marker: Marker, r: number): [number, number][] | null {
  switch (marker) {
    case 'circle':
      return null;
    case 'square':
      return [[-r, -r], [r, -r], [r, r], [-r, r]].map(([x, y]) => [x! * 0.9, y! * 0.9]);
    case 'triangle':
      return [[0, -1.2 * r], [1.1 * r, 0.9 * r], [-1.1 * r, 0.9 * r]];
    case 'diamond':
      return [[0, -1.3 * r], [1.3 * r, 0], [0, 1.3 * r], [-1.3 * r, 0]];
    case 'inverted':
      return [[0, 1.2 * r], [1.1 * r, -0.9 * r], [-1.1 * r, -0.9 * r]];
  }
}

const LOGARITHMIC_ROOM = 1.2; // above and below, as a ratio

/** The least and the greatest value at each place of the horizontal axis. */
export interface Envelope {
  x: number[]; // ascending
  low: (number | null)[];
  high: (number | null)[];
}

/** What all lines reach, with their intervals. */
export function envelopeOf(spec: Spec): Envelope {
  const ends = new Map<number, [number, number] | null>();
  for (const line of spec.lines) {
    line.x.forEach((x, i) => {
      const y = line.y[i];
      const known = ends.get(x) ?? null;
      if (y === null || y === undefined) {
        if (!known) ends.set(x, null);
        return;
      }
      const low = Math.min(y, line.low?.[i] ?? y, line.to?.[i] ?? y);
      const high = Math.max(y, line.high?.[i] ?? y, line.to?.[i] ?? y);
      if (!known) return ends.set(x, [low, high]);
      known[0] = Math.min(known[0], low);
      known[1] = Math.max(known[1], high);
    });
  }
  const x = [...ends.keys()].sort((a, b) => a - b);
  return { x, low: x.map((each) => ends.get(each)?.[0] ?? null), high: x.map((each) => ends.get(each)?.[1] ?? null) };
}

/** The least and the greatest value between `from` and `to`; null without values. */
export function extentOf(envelope: Envelope, from: number, to: number): [number, number] | null {
  let low = Infinity;
  let high = -Infinity;
  envelope.x.forEach((x, i) => {
    if (x < from || x > to || envelope.low[i] === null) return;
    low = Math.min(low, envelope.low[i]!);
    high = Math.max(high, envelope.high[i]!);
  });
  return low > high ? null : [low, high];
}

/** The range of the vertical axis: all values between `from` and `to` and the levels, with room above and below. */
export function rangeOf(spec: Spec, envelope = envelopeOf(spec), from = -Infinity, to = Infinity): [number, number] {
  if (spec.yRange) return spec.yRange;
  const extent = extentOf(envelope, from, to);
  if (!extent) return spec.yIsLogarithmic ? [1, 10] : [0, 1];
  let [low, high] = extent;
  if (spec.yIsLogarithmic) return [low / LOGARITHMIC_ROOM, high * LOGARITHMIC_ROOM];
  for (const level of spec.levels) {
    // A level far away would flatten the lines.
    if (level.value > low - 2 * (high - low) && level.value < high + 2 * (high - low)) {
      low = Math.min(low, level.value);
      high = Math.max(high, level.value);
    }
  }
  if (spec.fromZero && low >= 0) low = 0;
  const room = 0.07 * (high - low || Math.abs(high) || 1);
  return [spec.fromZero && low === 0 ? 0 : low - room, high + room];
}

/** An area around or beside a line: its edges, without the points that have none. */
export interface Area {
  x: number[];
  low: number[];
  high: number[];
}

/** Areas of intervals or fills of a line, one for each run of points that have both edges. */
export function areasOf(line: Line): Area[] {
  const low = line.low ?? (line.to ? line.y : undefined);
  const high = line.high ?? line.to;
  if (!low || !high) return [];
  const areas: Area[] = [];
  let isOpen = false;
  line.x.forEach((x, i) => {
    const [a, b] = [low[i], high[i]];
    const exists = a !== null && a !== undefined && b !== null && b !== undefined;
    if (exists) {
      if (!isOpen) areas.push({ x: [], low: [], high: [] });
      const area = areas.at(-1)!;
      area.x.push(x);
      area.low.push(a);
      area.high.push(b);
    }
    isOpen = exists;
  });
  return areas;
}

/** How opaque an area is: intervals lie over each other, fills of stacked lines do not. */
export const opacityOf = (line: Line): number => line.opacity ?? (line.to ? 0.55 : 0.15);

/** Moves labels apart: returns their positions, in the order given, at least `pitch` apart. */
export function spread(wanted: number[], pitch: number, low: number, high: number): number[] {
  const order = wanted.map((_, i) => i).sort((a, b) => wanted[a]! - wanted[b]!);
  const out = [...wanted];
  let previous = low - pitch;
  for (const i of order) previous = out[i] = Math.max(out[i]!, previous + pitch);
  let next = high + pitch;
  for (const i of [...order].reverse()) next = out[i] = Math.min(out[i]!, next - pitch);
  return out;
}

/** Whether a line breaks off behind its point i, at the end of a branch of steady states. */
export const endsBranch = (line: Line, i: number): boolean =>
  line.y[i] != null && ((i + 1 < line.y.length && line.y[i + 1] == null) || (i > 0 && line.y[i - 1] == null));

/** The last point of a line that has a value. */
export function lastOf(line: Line): { x: number; y: number } | null {
  for (let i = line.y.length - 1; i >= 0; --i) {
    const y = line.y[i];
    if (y !== null && y !== undefined) return { x: line.x[i]!, y };
  }
  return null;
}
