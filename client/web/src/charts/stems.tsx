import { useMemo, useRef } from 'preact/hooks';
import { useCanvas, useWidth } from './canvas';
import { drawAxes, frameOf } from './frame';
import { colorOf } from './spec';
import { useColors } from './theme';

/** A line from zero to each value, e.g. of a spectrum. */
export function Stems({ x, y, xLabel, yLabel, height }: { x: number[]; y: number[]; xLabel: string; yLabel: string; height: number }) {
  const box = useRef<HTMLDivElement>(null);
  const width = useWidth(box);
  const colors = useColors();
  const frame = useMemo(() => frameOf([0, ...x], [0, ...y], width, height), [x, y, width, height]);
  const canvas = useCanvas(width, height, (context) => {
    drawAxes(context, frame, colors, xLabel, yLabel);
    context.strokeStyle = context.fillStyle = colorOf(0, colors);
    context.lineWidth = 2;
    x.forEach((value, i) => {
      context.beginPath();
      context.moveTo(frame.x(value), frame.y(0));
      context.lineTo(frame.x(value), frame.y(y[i]!));
      context.stroke();
      context.beginPath();
      context.arc(frame.x(value), frame.y(y[i]!), 2.5, 0, 2 * Math.PI);
      context.fill();
    });
  }, [frame, xLabel, yLabel, colors]);
  return <div class="chart" ref={box} style={{ height: `${height}px` }} aria-hidden="true"><canvas ref={canvas} style={{ width: `${width}px`, height: `${height}px` }} /></div>;
}
