/** Round numbers that divide a range into about `count` parts. */
export function ticks(low: number, high: number, count: number): number[] {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 2.5, 5, 10].find((each) => each * power >= raw) ?? 10);
  const out: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) out.push(k * step);
  return out;
}

/** The text at a tick. */
export const tickText = (value: number): string => String(Number(value.toPrecision(6))).replace('-', '−');

/** Ticks of a logarithmic axis: 1, 2 and 5 of each decade. */
export function logarithmicTicks(low: number, high: number): number[] {
  const out: number[] = [];
  for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; ++power) {
    for (const each of [1, 2, 5]) {
      const value = Number((each * 10 ** power).toPrecision(1));
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) out.push(value);
    }
  }
  return out;
}

/** The place of values between the pixels `start` and `end` of an axis. */
export function placeOf(low: number, high: number, start: number, end: number, isLogarithmic = false): (value: number) => number {
  const scale = isLogarithmic ? Math.log10 : (value: number) => value;
  const span = scale(high) - scale(low) || 1;
  return (value) => start + ((scale(value) - scale(low)) / span) * (end - start);
}
