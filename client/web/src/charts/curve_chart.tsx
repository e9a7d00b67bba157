import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { useColors } from './theme';
import { tickText } from './ticks';
import { Contents, Tiles, type Places } from './contents';
import { colorOf, envelopeOf, extentOf, hasMarker, lastOf, rangeOf, spread, type Colors, type Envelope, type Spec } from './spec';

const FONT = 'system-ui, sans-serif';
const MOST_PLAIN = 10_000; // greater numbers are written as powers
const SUPERSCRIPTS = '⁰¹²³⁴⁵⁶⁷⁸⁹';

/** The text at a tick of a logarithmic axis: empty for null and for numbers that are not round. */
function logarithmicText(value: number | null): string {
  if (value === null) return '';
  const exponent = Math.floor(Math.log10(value) + 1e-9);
  const factor = Math.round(value / 10 ** exponent);
  if (Math.abs(value / 10 ** exponent - factor) > 1e-6) return '';
  if (value <= MOST_PLAIN) return tickText(value);
  return `${factor === 1 ? '' : `${factor}·`}10${[...String(exponent)].map((each) => SUPERSCRIPTS[Number(each)]).join('')}`;
}

const tickTexts = (_u: uPlot, all: (number | null)[]): string[] => all.map((each) => (each === null ? '' : tickText(each)));

const hatches = new Map<string, CanvasPattern | string>();

/** Oblique lines of a color as a fill, made once. */
function hatch(context: CanvasRenderingContext2D, color: string, ratio: number): CanvasPattern | string {
  const key = `${color} ${ratio}`;
  const known = hatches.get(key);
  if (known) return known;
  const tile = document.createElement('canvas');
  tile.width = tile.height = Math.round(6 * ratio);
  const ink = tile.getContext('2d')!;
  ink.strokeStyle = color;
  ink.lineWidth = ratio;
  ink.beginPath();
  ink.moveTo(0, tile.height);
  ink.lineTo(tile.width, 0);
  ink.stroke();
  const made = context.createPattern(tile, 'repeat') ?? color;
  hatches.set(key, made);
  return made;
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
    if (isSmall) continue;
    // A rim of the background keeps the words readable over lines.
    ctx.save();
    ctx.setLineDash([]);
    ctx.strokeStyle = colors.background;
    ctx.lineWidth = 4 * ratio;
    ctx.lineJoin = 'round';
    ctx.strokeText(level.label, bbox.left + 6 * ratio, y - 3 * ratio);
    ctx.restore();
    ctx.fillText(level.label, bbox.left + 6 * ratio, y - 3 * ratio);
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

function drawContents(u: uPlot, contents: Contents, tiles: Tiles | null, yRange: [number, number]): void {
  const { ctx, bbox } = u;
  const ratio = devicePixelRatio;
  const range: [number, number] = [u.scales['x']!.min!, u.scales['x']!.max!];
  if (tiles) {
    tiles.draw(ctx, { ...bbox, ratio, range, y: (value) => u.valToPos(value, 'y', true) - bbox.top }, yRange.join());
    return;
  }
  const places: Places = { x: (value) => u.valToPos(value, 'x', true), y: (value) => u.valToPos(value, 'y', true), ratio };
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left - 5 * ratio, bbox.top - 5 * ratio, bbox.width + 10 * ratio, bbox.height + 10 * ratio);
  ctx.clip();
  contents.paint(ctx, places, ...range);
  ctx.restore();
}

const WHEEL_ZOOM = 1.002; // change of the span by one unit of a wheel
const SETTLING_MILLISECONDS = 250; // after the last turn of a wheel

/** What a plot shows of its axes, and whether it is being moved. */
interface Motion {
  isMoving: boolean;
  y: [number, number]; // range of the vertical axis
}

/**
 * Moves a plot while it is dragged with Shift, zooms it with Ctrl and the wheel; `onEnd` gets the new
 * range. The picture changes at most once a frame.
 */
function addMoves(u: uPlot, motion: Motion, isLogarithmic: boolean, onEnd: (range: [number, number]) => void): void {
  const forward = isLogarithmic ? Math.log10 : (value: number) => value;
  const back = isLogarithmic ? (value: number) => 10 ** value : (value: number) => value;
  const all = [u.data[0][0] ?? 0, u.data[0].at(-1) ?? 1].map(forward) as [number, number];
  let wanted: [number, number] | null = null;
  let frame = 0;
  const apply = () => {
    cancelAnimationFrame(frame);
    frame = 0;
    if (wanted) u.setScale('x', { min: back(wanted[0]), max: back(wanted[1]) });
    wanted = null;
  };
  const show = (from: number, to: number) => {
    const span = Math.min(to - from, all[1] - all[0]);
    const min = Math.min(Math.max(from, all[0]), all[1] - span);
    wanted = [min, min + span];
    if (frame === 0) frame = requestAnimationFrame(apply);
  };
  const present = (): [number, number] => wanted ?? [forward(u.scales['x']!.min!), forward(u.scales['x']!.max!)];
  let start: { x: number; min: number; max: number } | null = null;
  u.over.addEventListener('pointerdown', (event) => {
    if (!event.shiftKey || event.button !== 0) return;
    u.over.setPointerCapture(event.pointerId);
    u.setCursor({ left: -10, top: -10 });
    const [min, max] = present();
    start = { x: event.clientX, min, max };
    motion.isMoving = true;
  });
  u.over.addEventListener('pointermove', (event) => {
    if (!start) return;
    const distance = ((event.clientX - start.x) / u.over.clientWidth) * (start.max - start.min);
    show(start.min - distance, start.max - distance);
  });
  const end = () => {
    if (!start) return;
    start = null;
    motion.isMoving = false;
    const [min, max] = present().map(back) as [number, number];
    wanted = null;
    cancelAnimationFrame(frame);
    frame = 0;
    u.setScale('x', { min, max });
    onEnd([min, max]);
  };
  u.over.addEventListener('pointerup', end);
  u.over.addEventListener('pointercancel', end);
  let timer: number | undefined;
  u.over.addEventListener('wheel', (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    const [min, max] = present();
    const at = min + (event.offsetX / u.over.clientWidth) * (max - min);
    const factor = WHEEL_ZOOM ** event.deltaY;
    show(at - (at - min) * factor, at + (max - at) * factor);
    clearTimeout(timer);
    timer = window.setTimeout(() => {
      apply();
      onEnd([u.scales['x']!.min!, u.scales['x']!.max!]);
    }, SETTLING_MILLISECONDS);
  }, { passive: false });
}

/** The range of the vertical axis of a plot that is moved: it stays as long as it holds the lines. */
function movedRange(spec: Spec, envelope: Envelope, present: [number, number], from: number, to: number): [number, number] {
  const extent = extentOf(envelope, from, to);
  if (!extent || (extent[0] >= present[0] && extent[1] <= present[1])) return present;
  // Room for what comes next: the lines are painted afresh less often.
  const ahead = (to - from) / 2;
  return rangeOf(spec, envelope, from - ahead, to + ahead);
}

export interface CurveChartProps {
  spec: Spec;
  height: number;
  isSmall?: boolean;
  sync: string;
  xRange?: [number, number] | undefined; // that is shown; default: that of the spec
  onSpeed?: (speed: number) => void;
  onPick?: (speed: number) => void;
  /** If set, the owner zooms: a dragged range, or null for all. */
  onZoom?: (range: [number, number] | null) => void;
}

/** A plot of curves over speed: a drag zooms, with Shift it moves; a double click goes back; the cursor snaps to speeds. */
export function CurveChart({ spec, height, isSmall = false, sync, xRange = spec.xRange, onSpeed, onPick, onZoom }: CurveChartProps) {
  const box = useRef<HTMLDivElement>(null);
  const shown = useRef<{ plot: uPlot; all: [number, number] } | null>(null);
  const colors = useColors();
  const handlers = useRef({ onSpeed, onPick, onZoom });
  handlers.current = { onSpeed, onPick, onZoom };
  const isOwned = onZoom !== undefined;

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
    const envelope = envelopeOf(spec);
    const contents = new Contents(spec, colors, isSmall);
    const tiles = isSmall ? null : new Tiles(contents, spec.xIsLogarithmic === true);
    const motion: Motion = { isMoving: false, y: rangeOf(spec, envelope) };
    const all: [number, number] = [envelope.x[0] ?? 0, envelope.x.at(-1) ?? 1];
    if (all[0] === all[1]) {
      all[0] -= 0.5;
      all[1] += 0.5;
    }
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
          drag: { x: true, y: false, setScale: !isOwned, click: () => {} },
          // With Shift a drag moves the plot: see addMoves().
          bind: {
            mousedown: (_u, _target, handler) => (event) => { if (!event.shiftKey) handler(event); return null; },
            mousemove: (_u, _target, handler) => (event) => { if (!motion.isMoving) handler(event); return null; },
          },
          points: { show: false },
          move: (u, left, top) => {
            const x = u.data[0][u.posToIdx(left)];
            return [left < 0 || x === undefined ? left : u.valToPos(x, 'x'), top];
          },
        },
        scales: {
          x: {
            time: false, ...(spec.xIsLogarithmic ? { distr: 3 as const } : {}),
            range: (_u, least, greatest) => {
              const [min, max] = least === null || least === greatest ? all : [least, greatest];
              motion.y = motion.isMoving ? movedRange(spec, envelope, motion.y, min, max) : rangeOf(spec, envelope, min, max);
              return [min, max];
            },
          },
          y: { ...(spec.yIsLogarithmic ? { distr: 3 as const } : {}), range: () => motion.y },
        },
        axes: [
          { ...axis, size: isSmall ? 24 : 30, space: isSmall ? 45 : 60, ...(spec.xIsLogarithmic ? {} : { values: tickTexts }) },
          { ...axis, size: isSmall ? 44 : 52, space: isSmall ? 26 : 36, values: spec.yIsLogarithmic ? (_u, all) => all.map(logarithmicText) : tickTexts },
        ],
        // uPlot has the axes and the cursor; the lines are painted below.
        series: [{}, { paths: () => null, points: { show: false } }],
        hooks: {
          drawClear: [(u) => drawRegions(u, spec, colors, isSmall)],
          draw: [
            (u) => drawContents(u, contents, tiles, motion.y),
            (u) => drawLevels(u, spec, colors, isSmall),
            (u) => hasLabels && drawLabels(u, spec, colors),
          ],
          setCursor: [
            (u) => {
              if (motion.isMoving) return;
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
              if (!isSmall) addMoves(u, motion, spec.xIsLogarithmic === true, (range) => handlers.current.onZoom?.(range));
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
      [envelope.x, envelope.low],
      box.current!,
    );
    shown.current = { plot, all };
    const observer = new ResizeObserver(() => {
      const next = box.current?.clientWidth ?? 0;
      if (next > 0 && next !== plot.width) plot.setSize({ width: next, height });
    });
    observer.observe(box.current!);
    return () => {
      observer.disconnect();
      plot.destroy();
    };
  }, [spec, height, colors, isSmall, sync, isOwned]);

  useEffect(() => {
    const { plot, all } = shown.current!;
    const [min, max] = xRange ?? all;
    if (plot.scales['x']!.min !== min || plot.scales['x']!.max !== max) plot.setScale('x', { min, max });
  }, [spec, height, colors, isSmall, sync, isOwned, xRange?.[0], xRange?.[1]]);

  return <div class="chart" ref={box} style={{ height: `${height}px` }} aria-hidden="true" />;
}
