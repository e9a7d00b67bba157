import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { useColors } from './theme';
import { tickText } from './ticks';
import { areasOf, colorOf, corners, DASHES, endsBranch, hasMarker, lastOf, MARKERS, opacityOf, rangeOf, spread, type Colors, type Line, type Spec } from './spec';

const FONT = 'system-ui, sans-serif';
const MOST_PLAIN = 10_000; // greater numbers are written as powers
const SUPERSCRIPTS = '⁰¹²³⁴⁵⁶⁷⁸⁹';

/** The text at a tick of a logarithmic axis; null has none. */
function logarithmicText(value: number | null): string {
  if (value === null || value <= MOST_PLAIN) return value === null ? '' : tickText(value);
  const exponent = Math.floor(Math.log10(value) + 1e-9);
  const factor = Math.round(value / 10 ** exponent);
  return `${factor === 1 ? '' : `${factor}·`}10${[...String(exponent)].map((each) => SUPERSCRIPTS[Number(each)]).join('')}`;
}

const WHISKER_PIXELS = 1.5; // a smaller error is thinner than the line

function hatch(context: CanvasRenderingContext2D, color: string, ratio: number): CanvasPattern | string {
  const tile = document.createElement('canvas');
  tile.width = tile.height = Math.round(6 * ratio);
  const ink = tile.getContext('2d')!;
  ink.strokeStyle = color;
  ink.lineWidth = ratio;
  ink.beginPath();
  ink.moveTo(0, tile.height);
  ink.lineTo(tile.width, 0);
  ink.stroke();
  return context.createPattern(tile, 'repeat') ?? color;
}

function drawRegions(u: uPlot, spec: Spec, colors: Colors, isSmall: boolean): void {
  const { ctx, bbox } = u;
  const ratio = devicePixelRatio;
  const span = (from: number, to: number): [number, number] => {
    const left = Math.max(u.valToPos(from, 'x', true), bbox.left);
    return [left, Math.min(u.valToPos(to, 'x', true), bbox.left + bbox.width) - left];
  };
  ctx.save();
  ctx.fillStyle = colors.parted;
  for (const [from, to] of spec.parted) {
    const [left, width] = span(from, to);
    if (width > 0) ctx.fillRect(left, bbox.top, width, bbox.height);
  }
  ctx.globalAlpha = 0.55;
  ctx.fillStyle = hatch(ctx, colors.outside, ratio);
  for (const [from, to] of spec.outside) {
    const [left, width] = span(from, to);
    if (width > 0) ctx.fillRect(left, bbox.top, width, bbox.height);
  }
  ctx.globalAlpha = 0.8;
  ctx.fillStyle = hatch(ctx, colors.caution, ratio);
  for (const [from, to] of isSmall ? [] : spec.caution) {
    const [left, width] = span(from, to);
    if (width > 0) ctx.fillRect(left, bbox.top - 7 * ratio, width, 5 * ratio);
  }
  ctx.restore();
}

function drawAreas(u: uPlot, spec: Spec, colors: Colors): void {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  for (const line of spec.lines) {
    ctx.fillStyle = colorOf(line.series, colors);
    ctx.globalAlpha = opacityOf(line);
    for (const area of areasOf(line)) {
      ctx.beginPath();
      const corner = (i: number, value: number) => ctx.lineTo(u.valToPos(area.x[i]!, 'x', true), u.valToPos(value, 'y', true));
      area.high.forEach((value, i) => corner(i, value));
      for (let i = area.low.length - 1; i >= 0; --i) corner(i, area.low[i]!);
      ctx.fill();
    }
  }
  ctx.restore();
}

function drawLevels(u: uPlot, spec: Spec, colors: Colors, isSmall: boolean): void {
  const { ctx, bbox } = u;
  const ratio = devicePixelRatio;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = colors.muted;
  ctx.lineWidth = ratio;
  ctx.setLineDash([4 * ratio, 4 * ratio]);
  ctx.font = `${11.5 * ratio}px ${FONT}`;
  ctx.textAlign = 'left';
  ctx.textBaseline = 'bottom';
  for (const level of spec.levels) {
    const y = u.valToPos(level.value, 'y', true);
    if (y < bbox.top || y > bbox.top + bbox.height) continue;
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    if (!isSmall) ctx.fillText(level.label, bbox.left + 6 * ratio, y - 3 * ratio);
  }
  ctx.restore();
}

function drawMarkers(u: uPlot, spec: Spec, colors: Colors, isSmall: boolean): void {
  const { ctx, bbox } = u;
  const ratio = devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left - 5 * ratio, bbox.top - 5 * ratio, bbox.width + 10 * ratio, bbox.height + 10 * ratio);
  ctx.clip();
  for (const line of spec.lines) {
    if (spec.hasMarkers === false || !hasMarker(line.series)) continue;
    ctx.strokeStyle = colorOf(line.series, colors);
    ctx.lineWidth = 1.5 * ratio;
    const radius = (isSmall ? 2 : 3.2) * ratio;
    const shape = corners(MARKERS[line.series]!, radius);
    // Markers need room: every n-th speed has one where there are many.
    const pixels = bbox.width / ratio / Math.max(1, line.x.length);
    const step = Math.max(1, Math.ceil((isSmall ? 14 : 10) / pixels));
    line.x.forEach((at, i) => {
      const value = line.y[i];
      if (value === null || value === undefined) return;
      const x = u.valToPos(at, 'x', true);
      const y = u.valToPos(value, 'y', true);
      if (endsBranch(line, i)) {
        const cap = (isSmall ? 4 : 8) * ratio;
        ctx.beginPath();
        ctx.moveTo(x, y - cap);
        ctx.lineTo(x, y + cap);
        ctx.stroke();
      }
      if (i % step !== 0) return;
      const error = line.error?.[i];
      if (error && !isSmall && spec.hasErrors !== false) {
        const reach = Math.abs(u.valToPos(value + error, 'y', true) - y);
        if (reach > WHISKER_PIXELS * ratio) {
          ctx.beginPath();
          ctx.moveTo(x, y - reach);
          ctx.lineTo(x, y + reach);
          ctx.stroke();
        }
      }
      ctx.beginPath();
      if (shape === null) ctx.arc(x, y, radius, 0, 2 * Math.PI);
      else shape.forEach(([dx, dy], k) => (k === 0 ? ctx.moveTo(x + dx, y + dy) : ctx.lineTo(x + dx, y + dy)));
      ctx.closePath();
      ctx.fillStyle = line.hollow[i] ? colors.background : colorOf(line.series, colors);
      ctx.fill();
      ctx.stroke();
    });
  }
  ctx.restore();
}

const MOST_LABELS = 12; // more lines have names only where they have a color

function drawLabels(u: uPlot, spec: Spec, colors: Colors): void {
  const { ctx, bbox } = u;
  const ratio = devicePixelRatio;
  const right = u.scales['x']!.max!;
  const ends = spec.lines.flatMap((line) => {
    const end = line.label === '' || (spec.lines.length > MOST_LABELS && !hasMarker(line.series)) ? null : lastOf(line);
    return end !== null && end.x <= right ? [{ line, y: u.valToPos(end.y, 'y', true) }] : [];
  });
  const places = spread(ends.map((each) => each.y), 17 * ratio, bbox.top + 6 * ratio, bbox.top + bbox.height - 6 * ratio);
  ctx.save();
  ctx.font = `600 ${12 * ratio}px ${FONT}`;
  ctx.textAlign = 'left';
  ctx.textBaseline = 'middle';
  ends.forEach(({ line, y }, i) => {
    const left = bbox.left + bbox.width;
    ctx.strokeStyle = ctx.fillStyle = colorOf(line.series, colors);
    ctx.lineWidth = ratio;
    ctx.beginPath();
    ctx.moveTo(left + 6 * ratio, y);
    ctx.lineTo(left + 14 * ratio, places[i]!);
    ctx.stroke();
    ctx.fillText(line.label, left + 18 * ratio, places[i]!);
  });
  ctx.restore();
}

/** Where a line is broken, in pixels: from the last value before a null to the first one after it. */
function gapsOf(u: uPlot, line: Line): [number, number][] {
  const gaps: [number, number][] = [];
  let last = -1;
  line.y.forEach((value, i) => {
    if (value === null) return;
    if (last >= 0 && i > last + 1) gaps.push([u.valToPos(line.x[last]!, 'x', true), u.valToPos(line.x[i]!, 'x', true)]);
    last = i;
  });
  return gaps;
}

/** Lines over one axis of speeds; undefined where a line has no such speed. */
function aligned(spec: Spec): uPlot.AlignedData {
  const speeds = [...new Set(spec.lines.flatMap((line) => line.x))].sort((a, b) => a - b);
  const columns = spec.lines.map((line) => {
    const values = new Map(line.x.map((x, i) => [x, line.y[i]]));
    return speeds.map((x) => (values.has(x) ? values.get(x) : undefined));
  });
  return [speeds, ...columns] as uPlot.AlignedData;
}

const WHEEL_ZOOM = 1.002; // change of the span by one unit of a wheel
const SETTLING_MILLISECONDS = 250; // after the last turn of a wheel

/** Moves a plot while it is dragged with Shift, zooms it with Ctrl and the wheel; `onEnd` gets the new range. */
function addMoves(u: uPlot, onEnd: (range: [number, number]) => void): void {
  const all: [number, number] = [u.data[0][0] ?? 0, u.data[0].at(-1) ?? 1];
  const show = (from: number, to: number) => {
    const span = Math.min(to - from, all[1] - all[0]);
    const min = Math.min(Math.max(from, all[0]), all[1] - span);
    u.setScale('x', { min, max: min + span });
  };
  const present = (): [number, number] => [u.scales['x']!.min!, u.scales['x']!.max!];
  let start: { x: number; min: number; max: number } | null = null;
  u.over.addEventListener('pointerdown', (event) => {
    if (!event.shiftKey || event.button !== 0) return;
    u.over.setPointerCapture(event.pointerId);
    const [min, max] = present();
    start = { x: event.clientX, min, max };
  });
  u.over.addEventListener('pointermove', (event) => {
    if (!start) return;
    const distance = ((event.clientX - start.x) / u.over.clientWidth) * (start.max - start.min);
    show(start.min - distance, start.max - distance);
  });
  u.over.addEventListener('pointerup', () => {
    if (start) onEnd(present());
    start = null;
  });
  let timer: number | undefined;
  u.over.addEventListener('wheel', (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    const [min, max] = present();
    const at = u.posToVal(event.offsetX, 'x');
    const factor = WHEEL_ZOOM ** event.deltaY;
    show(at - (at - min) * factor, at + (max - at) * factor);
    clearTimeout(timer);
    timer = window.setTimeout(() => onEnd(present()), SETTLING_MILLISECONDS);
  }, { passive: false });
}

export interface CurveChartProps {
  spec: Spec;
  height: number;
  isSmall?: boolean;
  sync: string;
  onSpeed?: (speed: number) => void;
  onPick?: (speed: number) => void;
  /** If set, the owner zooms: a dragged range, or null for all. */
  onZoom?: (range: [number, number] | null) => void;
}

/** A plot of curves over speed: a drag zooms, with Shift it moves; a double click goes back; the cursor snaps to speeds. */
export function CurveChart({ spec, height, isSmall = false, sync, onSpeed, onPick, onZoom }: CurveChartProps) {
  const box = useRef<HTMLDivElement>(null);
  const colors = useColors();
  const handlers = useRef({ onSpeed, onPick, onZoom });
  handlers.current = { onSpeed, onPick, onZoom };

  useEffect(() => {
    const width = box.current!.clientWidth;
    const longest = Math.max(0, ...spec.lines.map((line) => line.label.length));
    const hasLabels = !isSmall && spec.hasMarkers !== false && longest > 0 && width > (longest < 10 ? 420 : 620);
    const axis = {
      stroke: colors.muted,
      font: `${isSmall ? 10.5 : 12}px ${FONT}`,
      grid: { stroke: colors.grid, width: 1 },
      ticks: { stroke: colors.grid, width: 1, size: 4 },
    };
    const data = aligned(spec);
    const plot = new uPlot(
      {
        width,
        height,
        padding: [isSmall ? 8 : 14, hasLabels ? Math.min(190, 30 + 7 * longest) : 12, 0, 0],
        legend: { show: false },
        cursor: {
          sync: { key: sync },
          y: false,
          // The snapped cursor makes each click look like a drag to uPlot, which would swallow the click.
          drag: { x: true, y: false, setScale: onZoom === undefined, click: () => {} },
          // With Shift a drag moves the plot: see addMoves().
          bind: {
            mousedown: (_u, _target, handler) => (event) => { if (!event.shiftKey) handler(event); return null; },
            mousemove: (_u, _target, handler) => (event) => { if (!event.shiftKey || event.buttons === 0) handler(event); return null; },
          },
          points: { show: false },
          move: (u, left, top) => {
            const x = u.data[0][u.posToIdx(left)];
            return [left < 0 || x === undefined ? left : u.valToPos(x, 'x'), top];
          },
        },
        scales: {
          x: { time: false, ...(spec.xIsLogarithmic ? { distr: 3 as const } : {}) },
          y: { ...(spec.yIsLogarithmic ? { distr: 3 as const } : {}), range: (u) => rangeOf(spec, u.scales['x']!.min ?? -Infinity, u.scales['x']!.max ?? Infinity) },
        },
        axes: [
          { ...axis, size: isSmall ? 24 : 30, space: isSmall ? 45 : 60 },
          { ...axis, size: isSmall ? 44 : 52, space: isSmall ? 26 : 36, ...(spec.yIsLogarithmic ? { values: (_u: uPlot, all: (number | null)[]) => all.map(logarithmicText) } : {}) },
        ],
        series: [
          {},
          ...spec.lines.map((line) => ({
            stroke: colorOf(line.series, colors),
            width: isSmall ? 1.5 : hasMarker(line.series) ? 2 : 1.2,
            dash: DASHES[line.variant % DASHES.length]!,
            points: { show: false },
            ...(line.isMarksOnly ? { paths: () => null } : {}),
            gaps: (u: uPlot) => gapsOf(u, line),
          })),
        ],
        hooks: {
          drawClear: [(u) => drawRegions(u, spec, colors, isSmall)],
          drawAxes: [(u) => drawAreas(u, spec, colors)],
          draw: [
            (u) => drawLevels(u, spec, colors, isSmall),
            (u) => drawMarkers(u, spec, colors, isSmall),
            (u) => hasLabels && drawLabels(u, spec, colors),
          ],
          setCursor: [
            (u) => {
              const speed = u.cursor.idx === null || u.cursor.idx === undefined ? undefined : u.data[0][u.cursor.idx];
              if (speed !== undefined && u.cursor.left! >= 0) handlers.current.onSpeed?.(speed);
            },
          ],
          setSelect: [
            (u) => {
              const { left, width } = u.select;
              if (width > 2) handlers.current.onZoom?.([u.posToVal(left, 'x'), u.posToVal(left + width, 'x')]);
            },
          ],
          ready: [
            (u) => {
              if (!isSmall) addMoves(u, (range) => handlers.current.onZoom?.(range));
              u.over.addEventListener('dblclick', () => handlers.current.onZoom?.(null));
              let down = 0;
              u.over.addEventListener('mousedown', (event) => (down = event.clientX));
              u.over.addEventListener('click', (event) => {
                const speed = u.data[0][u.posToIdx(event.offsetX)];
                if (Math.abs(event.clientX - down) < 3 && speed !== undefined) handlers.current.onPick?.(speed);
              });
            },
          ],
        },
      },
      data,
      box.current!,
    );
    if (spec.xRange) plot.setScale('x', { min: spec.xRange[0], max: spec.xRange[1] });
    const observer = new ResizeObserver(() => {
      const next = box.current?.clientWidth ?? 0;
      if (next > 0 && next !== plot.width) plot.setSize({ width: next, height });
    });
    observer.observe(box.current!);
    return () => {
      observer.disconnect();
      plot.destroy();
    };
  }, [spec, height, colors, isSmall, sync]);

  return <div class="chart" ref={box} style={{ height: `${height}px` }} aria-hidden="true" />;
}
