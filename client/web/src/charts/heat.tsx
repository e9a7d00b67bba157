import { useRef, useState } from 'preact/hooks';
import { FONT, useCanvas, useWidth } from './canvas';
import { useColors } from './theme';

interface HeatProps {
  x: string[]; // texts of the columns
  y: string[]; // of the rows, from below
  values: (number | null)[][]; // by row and column, in the shown unit
  xLabel: string;
  yLabel: string;
  height: number;
  isLogarithmic: boolean; // of the color
  words: (row: number, column: number) => string; // of a cell under the pointer
}

const LEFT = 62;
const BOTTOM = 42;
const TOP = 8;
const RIGHT = 10;
const LEAST_PITCH = 46; // [px] between texts of columns

/** Colors from pale to dark (dark theme: from dark to pale) in one hue, so that lightness alone orders them. */
const colorAt = (share: number, isDark: boolean): string =>
  (isDark ? `hsl(${215 - 25 * share} ${50 + 20 * share}% ${16 + 62 * share}%)` : `hsl(${195 + 25 * share} ${45 + 35 * share}% ${94 - 66 * share}%)`);

/** A quantity over two others, a cell for each pair. */
export function Heat({ x, y, values, xLabel, yLabel, height, isLogarithmic, words }: HeatProps) {
  const box = useRef<HTMLDivElement>(null);
  const width = useWidth(box);
  const colors = useColors();
  const [under, setUnder] = useState<[number, number] | null>(null);
  const scale = isLogarithmic ? Math.log : (value: number) => value;
  const finite = values.flat().filter((value): value is number => value !== null && (!isLogarithmic || value > 0));
  const [low, high] = [scale(Math.min(...finite)), scale(Math.max(...finite))];
  const cellWidth = (width - LEFT - RIGHT) / x.length;
  const cellHeight = (height - TOP - BOTTOM) / y.length;
  const canvas = useCanvas(width, height, (context) => {
    const isDark = colors.background !== '#ffffff';
    values.forEach((row, i) => row.forEach((value, k) => {
      const top = height - BOTTOM - (i + 1) * cellHeight;
      context.fillStyle = value === null || (isLogarithmic && value <= 0) ? colors.parted : colorAt((scale(value) - low) / (high - low || 1), isDark);
      // Neighbours overlap by a pixel, which leaves no seams.
      context.fillRect(LEFT + k * cellWidth, top, cellWidth + 1, cellHeight + 1);
    }));
    context.font = `12px ${FONT}`;
    context.fillStyle = colors.muted;
    context.textAlign = 'center';
    const step = Math.max(1, Math.ceil(LEAST_PITCH / cellWidth));
    x.forEach((text, k) => k % step === 0 && context.fillText(text, LEFT + (k + 0.5) * cellWidth, height - BOTTOM + 16));
    context.fillText(xLabel, (LEFT + width - RIGHT) / 2, height - 6);
    context.textAlign = 'right';
    const rise = Math.max(1, Math.ceil(18 / cellHeight));
    y.forEach((text, i) => i % rise === 0 && context.fillText(text, LEFT - 8, height - BOTTOM - (i + 0.5) * cellHeight + 4));
    context.textAlign = 'center';
    context.save();
    context.translate(11, (TOP + height - BOTTOM) / 2);
    context.rotate(-Math.PI / 2);
    context.fillText(yLabel, 0, 0);
    context.restore();
  }, [values, x, y, xLabel, yLabel, colors]);
  const cellAt = (event: MouseEvent): [number, number] | null => {
    const place = canvas.current!.getBoundingClientRect();
    const k = Math.floor((event.clientX - place.left - LEFT) / cellWidth);
    const i = Math.floor((height - BOTTOM - (event.clientY - place.top)) / cellHeight);
    return k >= 0 && k < x.length && i >= 0 && i < y.length ? [i, k] : null;
  };
  const left = under ? LEFT + (under[1] + 0.5) * cellWidth : 0;
  return (
    <div class="chart scatter" ref={box} style={{ height: `${height}px` }} aria-hidden="true"
      onMouseMove={(event) => setUnder(cellAt(event))} onMouseLeave={() => setUnder(null)}>
      <canvas ref={canvas} style={{ width: `${width}px`, height: `${height}px` }} />
      {under && (
        <span class="tip" style={{ top: `${height - BOTTOM - (under[0] + 1) * cellHeight - 20}px`, ...(left > width / 2 ? { right: `${width - left}px` } : { left: `${left}px` }) }}>
          {words(under[0], under[1])}
        </span>
      )}
    </div>
  );
}
