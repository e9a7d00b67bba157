import { areasOf, colorOf, corners, DASHES, endsBranch, hasMarker, MARKERS, opacityOf, type Area, type Colors, type Line, type Spec } from './spec';

/** Where values lie on a canvas, in its own pixels. */
export interface Places {
  x: (value: number) => number;
  y: (value: number) => number;
  ratio: number; // pixels of the canvas per pixel of the page
}

const WHISKER_PIXELS = 1.5; // a smaller error is thinner than the line
const LEAST_PITCH = { large: 10, small: 14 }; // [px] between markers of a line
export const MARKER_REACH = 9; // [px] from the value of a marker to its farthest ink

const isAscending = (values: number[]): boolean => values.every((value, i) => i === 0 || value >= values[i - 1]!);

/** The first index whose value is at least `bound`. */
function lowerIndex(values: number[], bound: number): number {
  let [low, high] = [0, values.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle]! < bound) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** A line with what does not change while it moves. */
interface Prepared {
  line: Line;
  isAscending: boolean;
  areas: Area[];
}

/** Areas, lines and markers of a plot, painted over any range of its axis. */
export class Contents {
  private readonly lines: Prepared[];

  constructor(private readonly spec: Spec, private readonly colors: Colors, private readonly isSmall: boolean) {
    this.lines = spec.lines.map((line) => ({ line, isAscending: isAscending(line.x), areas: areasOf(line) }));
  }

  /** Paints areas, lines and markers between the values `from` and `to` of the axis. */
  paint(context: CanvasRenderingContext2D, places: Places, from: number, to: number): void {
    context.lineJoin = 'round';
    for (const each of this.lines) this.paintAreas(context, places, each, from, to);
    for (const each of this.lines) this.paintLine(context, places, each, from, to);
    if (this.spec.hasMarkers === false) return;
    for (const each of this.lines) if (hasMarker(each.line.series)) this.paintMarkers(context, places, each, from, to);
  }

  /** The points between two values and one more at each side. */
  private rowsOf(values: number[], ascends: boolean, from: number, to: number): [number, number] {
    if (!ascends) return [0, values.length - 1];
    return [Math.max(0, lowerIndex(values, from) - 1), Math.min(values.length - 1, lowerIndex(values, to))];
  }

  private paintAreas(context: CanvasRenderingContext2D, { x, y }: Places, { line, isAscending, areas }: Prepared, from: number, to: number): void {
    context.fillStyle = colorOf(line.series, this.colors);
    context.globalAlpha = opacityOf(line);
    for (const area of areas) {
      const [first, last] = this.rowsOf(area.x, isAscending, from, to);
      context.beginPath();
      for (let i = first; i <= last; ++i) context.lineTo(x(area.x[i]!), y(area.high[i]!));
      for (let i = last; i >= first; --i) context.lineTo(x(area.x[i]!), y(area.low[i]!));
      context.fill();
    }
    context.globalAlpha = 1;
  }

  private paintLine(context: CanvasRenderingContext2D, { x, y, ratio }: Places, { line, isAscending }: Prepared, from: number, to: number): void {
    if (line.isMarksOnly) return;
    const [first, last] = this.rowsOf(line.x, isAscending, from, to);
    context.strokeStyle = colorOf(line.series, this.colors);
    context.lineWidth = (this.isSmall ? 1.5 : hasMarker(line.series) ? 2 : 1.2) * ratio;
    const dash = DASHES[line.variant % DASHES.length]!;
    if (dash.length > 0) {
      // Dashes continue from one painted range to the next: they count from the start of the line.
      let length = 0;
      for (let i = 1; i <= first; ++i) {
        if (line.y[i] != null && line.y[i - 1] != null) length += Math.hypot(x(line.x[i]!) - x(line.x[i - 1]!), y(line.y[i]!) - y(line.y[i - 1]!));
      }
      context.setLineDash(dash.map((each) => each * ratio));
      context.lineDashOffset = length;
    }
    context.beginPath();
    let isOpen = false;
    for (let i = first; i <= last; ++i) {
      const value = line.y[i];
      if (value != null) context[isOpen ? 'lineTo' : 'moveTo'](x(line.x[i]!), y(value));
      isOpen = value != null;
    }
    context.stroke();
    if (dash.length > 0) context.setLineDash([]);
  }

  private paintMarkers(context: CanvasRenderingContext2D, { x, y, ratio }: Places, { line, isAscending }: Prepared, from: number, to: number): void {
    const color = colorOf(line.series, this.colors);
    context.strokeStyle = color;
    context.lineWidth = 1.5 * ratio;
    const radius = (this.isSmall ? 2 : 3.2) * ratio;
    const shape = corners(MARKERS[line.series]!, radius);
    // Markers need room: every n-th speed has one where there are many.
    const pitch = Math.abs(x(line.x.at(-1)!) - x(line.x[0]!)) / ratio / Math.max(1, line.x.length - 1);
    const step = pitch > 0 ? Math.max(1, Math.ceil(LEAST_PITCH[this.isSmall ? 'small' : 'large'] / pitch)) : 1;
    const [first, last] = this.rowsOf(line.x, isAscending, from, to);
    for (let i = first; i <= last; ++i) {
      const value = line.y[i];
      if (value == null) continue;
      const [left, top] = [x(line.x[i]!), y(value)];
      if (endsBranch(line, i)) {
        const cap = (this.isSmall ? 4 : 8) * ratio;
        context.beginPath();
        context.moveTo(left, top - cap);
        context.lineTo(left, top + cap);
        context.stroke();
      }
      if (i % step !== 0) continue;
      const error = line.error?.[i];
      if (error && !this.isSmall && this.spec.hasErrors !== false) {
        const reach = Math.abs(y(value + error) - top);
        if (reach > WHISKER_PIXELS * ratio) {
          context.beginPath();
          context.moveTo(left, top - reach);
          context.lineTo(left, top + reach);
          context.stroke();
        }
      }
      context.beginPath();
      if (shape === null) context.arc(left, top, radius, 0, 2 * Math.PI);
      else shape.forEach(([dx, dy], k) => (k === 0 ? context.moveTo(left + dx, top + dy) : context.lineTo(left + dx, top + dy)));
      context.closePath();
      context.fillStyle = line.hollow[i] ? this.colors.background : color;
      context.fill();
      context.stroke();
    }
  }
}

const TILE_PIXELS = 128; // of the page; a tile is painted in a fraction of a frame
const KEPT_VIEWS = 2; // tiles farther than so many widths of the plot are dropped

/** The part of a plot that is shown, in pixels of its canvas. */
export interface Frame {
  left: number;
  top: number;
  width: number;
  height: number;
  ratio: number;
  range: [number, number]; // of the horizontal axis
  y: (value: number) => number; // from the top of the frame
}

/**
 * The contents of a plot as tiles side by side. A tile is painted once for a scale; a plot that moves
 * copies it from place to place.
 */
export class Tiles {
  private readonly tiles = new Map<number, HTMLCanvasElement>();
  private scale = 1; // pixels of the canvas per unit of the axis (per power of ten of a logarithmic one)
  private key = '';

  constructor(private readonly contents: Contents, private readonly isLogarithmic: boolean) {}

  /** Copies the tiles of a frame to the canvas of the plot; `key` names the vertical scale. */
  draw(context: CanvasRenderingContext2D, frame: Frame, key: string): void {
    const forward = this.isLogarithmic ? Math.log10 : (value: number) => value;
    const back = this.isLogarithmic ? (value: number) => 10 ** value : (value: number) => value;
    const [first, last] = frame.range.map(forward) as [number, number];
    const scale = frame.width / (last - first);
    const whole = `${key} ${scale.toPrecision(9)} ${frame.width} ${frame.height} ${frame.ratio}`;
    if (whole !== this.key) {
      this.tiles.clear();
      this.key = whole;
      this.scale = scale;
    }
    const margin = Math.ceil(MARKER_REACH * frame.ratio);
    const size = Math.round(TILE_PIXELS * frame.ratio);
    const begin = Math.round(first * this.scale); // of the frame, counted from the zero of the axis
    const from = Math.floor((begin - margin) / size);
    const to = Math.floor((begin + frame.width + margin) / size);
    const far = (KEPT_VIEWS * frame.width) / size;
    for (const index of this.tiles.keys()) if (index < from - far || index > to + far) this.tiles.delete(index);
    context.save();
    context.beginPath();
    context.rect(frame.left - margin / 2, frame.top - margin / 2, frame.width + margin, frame.height + margin);
    context.clip();
    for (let index = from; index <= to; ++index) {
      let tile = this.tiles.get(index);
      if (!tile) {
        tile = document.createElement('canvas');
        tile.width = size;
        tile.height = Math.round(frame.height) + 2 * margin;
        const start = index * size;
        const valueAt = (pixel: number) => back(pixel / this.scale);
        this.contents.paint(tile.getContext('2d')!, {
          x: (value) => forward(value) * this.scale - start, y: (value) => frame.y(value) + margin, ratio: frame.ratio,
        }, valueAt(start - margin), valueAt(start + size + margin));
        this.tiles.set(index, tile);
      }
      context.drawImage(tile, Math.round(frame.left) + index * size - begin, Math.round(frame.top) - margin);
    }
    context.restore();
  }
}
