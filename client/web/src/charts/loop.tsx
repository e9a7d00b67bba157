import { useMemo, useRef } from 'preact/hooks';
import { useCanvas, useWidth } from './canvas';
import { drawAxes, frameOf } from './frame';
import { colorOf } from './spec';
import { useColors } from './theme';

interface LoopProps {
  x: number[]; // in shown units
  y: number[];
  xLabel: string;
  yLabel: string;
  height: number;
  level?: number | undefined; // a line at this x
  at: number | null; // index of the point that is marked
}

/** A closed path of one quantity over another. */
export function Loop({ x, y, xLabel, yLabel, height, level, at }: LoopProps) {
  const box = useRef<HTMLDivElement>(null);
  const width = useWidth(box);
  const colors = useColors();
  const frame = useMemo(() => frameOf(level === undefined ? x : [...x, level], y, width, height), [x, y, level, width, height]);
  const canvas = useCanvas(width, height, (context) => {
    drawAxes(context, frame, colors, xLabel, yLabel);
    context.lineWidth = 1.5;
    context.strokeStyle = colorOf(0, colors);
    context.beginPath();
    x.forEach((value, i) => context[i === 0 ? 'moveTo' : 'lineTo'](frame.x(value), frame.y(y[i]!)));
    context.stroke();
    if (level !== undefined) {
      context.lineWidth = 1;
      context.strokeStyle = colors.muted;
      context.setLineDash([4, 4]);
      context.beginPath();
      context.moveTo(frame.x(level), frame.y(frame.yRange[0]));
      context.lineTo(frame.x(level), frame.y(frame.yRange[1]));
      context.stroke();
      context.setLineDash([]);
    }
    if (at !== null && x[at] !== undefined) {
      context.fillStyle = colorOf(1, colors);
      context.beginPath();
      context.arc(frame.x(x[at]!), frame.y(y[at]!), 5, 0, 2 * Math.PI);
      context.fill();
    }
  }, [frame, xLabel, yLabel, at, colors]);
  return <div class="chart" ref={box} style={{ height: `${height}px` }} aria-hidden="true"><canvas ref={canvas} style={{ width: `${width}px`, height: `${height}px` }} /></div>;
}
