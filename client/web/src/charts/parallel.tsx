import { useRef, useState } from 'preact/hooks';
import { useCanvas, useWidth } from './canvas';
import { colorOf } from './spec';
import { useColors } from './theme';

/** An axis of parallel coordinates, in shown units. */
export interface Axis {
  key: string;
  label: string;
  unit: string;
  range: [number, number];
  ends: [string, string]; // texts of the least and the greatest value
  brush: [number, number] | null;
}

interface ParallelProps {
  axes: Axis[];
  lines: { key: number; values: (number | null)[]; isWithin: boolean }[]; // a value for each axis
  height: number;
  chosen: number | null;
  onBrush: (key: string, brush: [number, number] | null) => void;
}

const ROOM = 8; // [px] above and below an axis
const LEAST_BRUSH = 4; // [px]; a shorter stroke takes the brush away

/** A line for each candidate over several axes. A stroke along an axis keeps the lines through it. */
export function Parallel({ axes, lines, height, chosen, onBrush }: ParallelProps) {
  const box = useRef<HTMLDivElement>(null);
  const width = useWidth(box);
  const colors = useColors();
  const [stroke, setStroke] = useState<{ axis: number; from: number; to: number } | null>(null);
  const x = (axis: number) => ((axis + 0.5) / axes.length) * width;
  const y = (axis: Axis, value: number) => {
    const [low, high] = axis.range;
    return height - ROOM - ((value - low) / (high - low || 1)) * (height - 2 * ROOM);
  };
  const canvas = useCanvas(width, height, (context) => {
    const draw = (line: (typeof lines)[number]) => {
      context.beginPath();
      let isOpen = false;
      line.values.forEach((value, k) => {
        if (value !== null) context[isOpen ? 'lineTo' : 'moveTo'](x(k), y(axes[k]!, value));
        isOpen = value !== null;
      });
      context.stroke();
    };
    const within = lines.filter((line) => line.isWithin);
    context.lineWidth = 1;
    context.strokeStyle = colors.other;
    context.globalAlpha = 0.12;
    lines.forEach((line) => !line.isWithin && draw(line));
    context.strokeStyle = colorOf(0, colors);
    context.globalAlpha = Math.max(0.12, Math.min(0.8, 40 / (within.length + 1)));
    within.forEach(draw);
    const marked = lines.find((line) => line.key === chosen);
    if (marked) {
      context.globalAlpha = 1;
      context.lineWidth = 2.5;
      context.strokeStyle = colorOf(1, colors);
      draw(marked);
    }
  }, [axes, lines, chosen, colors]);
  const top = (event: PointerEvent) => event.clientY - canvas.current!.getBoundingClientRect().top;
  const valueAt = (axis: Axis, pixel: number) => {
    const share = (height - ROOM - Math.min(height - ROOM, Math.max(ROOM, pixel))) / (height - 2 * ROOM);
    return axis.range[0] + share * (axis.range[1] - axis.range[0]);
  };
  const end = () => {
    if (!stroke) return;
    const axis = axes[stroke.axis]!;
    const ends = [valueAt(axis, stroke.from), valueAt(axis, stroke.to)].sort((a, b) => a - b) as [number, number];
    onBrush(axis.key, Math.abs(stroke.to - stroke.from) < LEAST_BRUSH ? null : ends);
    setStroke(null);
  };
  return (
    <div class="parallel" style={{ minWidth: `${92 * axes.length}px` }} aria-hidden="true">
      <div class="parallel-labels" style={{ gridTemplateColumns: `repeat(${axes.length}, minmax(0, 1fr))` }}>
        {axes.map((axis) => <span key={axis.key}><strong>{axis.label}</strong>{axis.unit && ` ${axis.unit}`}<small>{axis.ends[1]}</small></span>)}
      </div>
      <div class="chart" ref={box} style={{ height: `${height}px` }}>
        <canvas ref={canvas} style={{ width: `${width}px`, height: `${height}px` }} />
        <svg width={width} height={height}>
          {axes.map((axis, k) => {
            const brush = stroke?.axis === k ? [stroke.from, stroke.to] : axis.brush?.map((value) => y(axis, Math.min(axis.range[1], Math.max(axis.range[0], value))));
            return (
              <g key={axis.key} class="parallel-axis" data-axis={axis.key}>
                <line x1={x(k)} x2={x(k)} y1={ROOM} y2={height - ROOM} />
                {brush && <rect class="brush" x={x(k) - 8} width={16} y={Math.min(...brush)} height={Math.max(2, Math.abs(brush[1]! - brush[0]!))} />}
                <rect class="handle" x={x(k) - 22} width={44} y={0} height={height}
                  onPointerDown={(event) => {
                    event.currentTarget.setPointerCapture(event.pointerId);
                    setStroke({ axis: k, from: top(event), to: top(event) });
                  }}
                  onPointerMove={(event) => stroke?.axis === k && setStroke({ ...stroke, to: top(event) })}
                  onPointerUp={end} onPointerCancel={() => setStroke(null)} />
              </g>
            );
          })}
        </svg>
      </div>
      <div class="parallel-labels" style={{ gridTemplateColumns: `repeat(${axes.length}, minmax(0, 1fr))` }}>
        {axes.map((axis) => <span key={axis.key}><small>{axis.ends[0]}</small></span>)}
      </div>
    </div>
  );
}
