import { useRef, useState } from 'preact/hooks';
import { useCanvas, useWidth } from './canvas';
import { drawAxes, frameOf } from './frame';
import { corners, colorOf, MARKERS } from './spec';
import { useColors } from './theme';

/** A point of a scatter plot, in shown units. */
export interface Dot {
  key: number;
  x: number;
  y: number;
  series: number; // color and marker; -1: in the background
  low?: number; // lower end of the interval of y, with `high`
  high?: number;
}

interface ScatterProps {
  dots: Dot[];
  xLabel: string;
  yLabel: string;
  height: number;
  chosen: number | null; // key of the dot that is marked
  steps?: { x: number; y: number }[]; // a line through dots, in order of x
  onChoose: (key: number) => void;
  words: (key: number) => string; // of a dot under the pointer
}

const REACH = 14; // [px] from the pointer to a dot
const MANY = 1500; // dots that need smaller markers

function drawDot(context: CanvasRenderingContext2D, x: number, y: number, series: number, radius: number): void {
  const shape = series < 0 ? null : corners(MARKERS[series] ?? 'circle', radius);
  context.beginPath();
  if (shape === null) context.arc(x, y, radius, 0, 2 * Math.PI);
  else shape.forEach(([dx, dy], k) => (k === 0 ? context.moveTo(x + dx, y + dy) : context.lineTo(x + dx, y + dy)));
  context.closePath();
}

/** One quantity against another, a dot for each candidate; a click chooses one. */
export function Scatter({ dots, xLabel, yLabel, height, chosen, steps = [], onChoose, words }: ScatterProps) {
  const box = useRef<HTMLDivElement>(null);
  const width = useWidth(box);
  const colors = useColors();
  const [under, setUnder] = useState<Dot | null>(null);
  const frame = frameOf(dots.map((each) => each.x), dots.flatMap((each) => (each.low === undefined ? [each.y] : [each.low, each.high!])), width, height);
  const canvas = useCanvas(width, height, (context) => {
    drawAxes(context, frame, colors, xLabel, yLabel);
    const radius = dots.length > MANY ? 2.2 : 3.6;
    const behindFirst = [...dots].sort((a, b) => Number(a.series >= 0) - Number(b.series >= 0));
    for (const dot of behindFirst) {
      context.globalAlpha = dot.series < 0 ? 0.6 : 0.75;
      context.fillStyle = context.strokeStyle = dot.series < 0 ? colors.other : colorOf(dot.series, colors);
      if (dot.low !== undefined && dot.series >= 0) {
        context.lineWidth = 1;
        context.beginPath();
        context.moveTo(frame.x(dot.x), frame.y(dot.low));
        context.lineTo(frame.x(dot.x), frame.y(dot.high!));
        context.stroke();
      }
      drawDot(context, frame.x(dot.x), frame.y(dot.y), dot.series, dot.series < 0 ? radius * 0.8 : radius);
      context.fill();
    }
    context.globalAlpha = 1;
    if (steps.length > 1) {
      context.strokeStyle = colorOf(1, colors);
      context.lineWidth = 1.5;
      context.beginPath();
      steps.forEach((each, i) => {
        if (i > 0) context.lineTo(frame.x(each.x), frame.y(steps[i - 1]!.y));
        context[i === 0 ? 'moveTo' : 'lineTo'](frame.x(each.x), frame.y(each.y));
      });
      context.stroke();
    }
    const marked = dots.find((each) => each.key === chosen);
    if (marked) {
      context.strokeStyle = colors.text;
      context.lineWidth = 2;
      drawDot(context, frame.x(marked.x), frame.y(marked.y), -1, 7);
      context.stroke();
    }
  }, [dots, steps, xLabel, yLabel, chosen, colors]);
  const nearest = (event: MouseEvent): Dot | null => {
    const place = canvas.current!.getBoundingClientRect();
    const [left, top] = [event.clientX - place.left, event.clientY - place.top];
    let best: Dot | null = null;
    let least = REACH;
    for (const dot of dots) {
      const distance = Math.hypot(frame.x(dot.x) - left, frame.y(dot.y) - top) + (dot.series < 0 ? REACH / 2 : 0);
      if (distance < least) [best, least] = [dot, distance];
    }
    return best;
  };
  return (
    <div class="chart scatter" ref={box} style={{ height: `${height}px` }} aria-hidden="true"
      onMouseMove={(event) => setUnder(nearest(event))} onMouseLeave={() => setUnder(null)}
      onClick={(event) => { const dot = nearest(event); if (dot) onChoose(dot.key); }}>
      <canvas ref={canvas} style={{ width: `${width}px`, height: `${height}px` }} />
      {under && (
        <span class="tip" style={frame.x(under.x) > width / 2
          ? { right: `${width - frame.x(under.x) + 10}px`, top: `${frame.y(under.y) - 12}px` }
          : { left: `${frame.x(under.x) + 10}px`, top: `${frame.y(under.y) - 12}px` }}>{words(under.key)}</span>
      )}
    </div>
  );
}
