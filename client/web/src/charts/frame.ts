import { FONT } from './canvas';
import type { Colors } from './spec';
import { tickText, ticks } from './ticks';

/** The axes of a plot on a canvas: places of values in pixels of the page. */
export interface Frame {
  x: (value: number) => number;
  y: (value: number) => number;
  xRange: [number, number];
  yRange: [number, number];
  width: number;
  height: number;
}

const LEFT = 56;
const RIGHT = 14;
const TOP = 10;
const BOTTOM = 42;

function rangeOf(values: number[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const each of values) {
    low = Math.min(low, each);
    high = Math.max(high, each);
  }
  if (low > high) return [0, 1];
  const room = 0.05 * (high - low || Math.abs(high) || 1);
  return [low - room, high + room];
}

/** Axes that hold all values, with room around them. */
export function frameOf(xs: number[], ys: number[], width: number, height: number): Frame {
  const xRange = rangeOf(xs);
  const yRange = rangeOf(ys);
  return {
    xRange, yRange, width, height,
    x: (value) => LEFT + ((value - xRange[0]) / (xRange[1] - xRange[0])) * (width - LEFT - RIGHT),
    y: (value) => height - BOTTOM - ((value - yRange[0]) / (yRange[1] - yRange[0])) * (height - TOP - BOTTOM),
  };
}

export function drawAxes(context: CanvasRenderingContext2D, frame: Frame, colors: Colors, xLabel: string, yLabel: string): void {
  const { width, height } = frame;
  context.font = `12px ${FONT}`;
  context.fillStyle = colors.muted;
  context.strokeStyle = colors.grid;
  context.lineWidth = 1;
  const rule = (x1: number, y1: number, x2: number, y2: number) => {
    context.beginPath();
    context.moveTo(Math.round(x1) + 0.5, Math.round(y1) + 0.5);
    context.lineTo(Math.round(x2) + 0.5, Math.round(y2) + 0.5);
    context.stroke();
  };
  context.textAlign = 'center';
  for (const each of ticks(...frame.xRange, Math.max(3, width / 110))) {
    rule(frame.x(each), TOP, frame.x(each), height - BOTTOM);
    context.fillText(tickText(each), frame.x(each), height - BOTTOM + 16);
  }
  context.textAlign = 'right';
  for (const each of ticks(...frame.yRange, Math.max(3, height / 60))) {
    rule(LEFT, frame.y(each), width - RIGHT, frame.y(each));
    context.fillText(tickText(each), LEFT - 8, frame.y(each) + 4);
  }
  context.textAlign = 'center';
  context.fillText(xLabel, (LEFT + width - RIGHT) / 2, height - 6);
  context.save();
  context.translate(11, (TOP + height - BOTTOM) / 2);
  context.rotate(-Math.PI / 2);
  context.fillText(yLabel, 0, 0);
  context.restore();
}
