import { logarithmicTicks, placeOf, tickText, ticks } from './ticks';
import { areasOf, colorOf, corners, DASHES, endsBranch, hasMarker, lastOf, LIGHT, MARKERS, opacityOf, rangeOf, spread, type Line, type Spec } from './spec';

const WIDTH = 960;
const LEFT = 64;
const TOP = 76;
const HEIGHT = 400;
const LINE_PITCH = 16;

const escaped = (text: string): string =>
  text.replace(/[&<>"]/g, (each) => `&#${each.charCodeAt(0)};`);

function markerText(line: Line, x: number, y: number, hollow: boolean): string {
  const color = colorOf(line.series, LIGHT);
  const look = `fill="${hollow ? LIGHT.background : color}" stroke="${color}" stroke-width="1.4"`;
  const shape = corners(MARKERS[line.series]!, 3);
  if (shape === null) return `<circle cx="${x.toFixed(1)}" cy="${y.toFixed(1)}" r="3" ${look}/>`;
  const points = shape.map(([dx, dy]) => `${(x + dx).toFixed(1)},${(y + dy).toFixed(1)}`).join(' ');
  return `<polygon points="${points}" ${look}/>`;
}

/** Paints a figure for reports: light, with the conditions beneath. */
export function svgOf(spec: Spec, footer: string[]): string {
  const longest = Math.max(0, ...spec.lines.map((line) => line.label.length));
  const right = WIDTH - Math.min(240, 34 + 7 * longest);
  const all = spec.lines.flatMap((line) => line.x);
  const [first, last] = [Math.min(...all), Math.max(...all)];
  const [low, high] = rangeOf(spec);
  const x = placeOf(first, last, LEFT, right, spec.xIsLogarithmic);
  const y = placeOf(low, high, TOP + HEIGHT, TOP, spec.yIsLogarithmic);
  const out: string[] = [];
  const text = (at: [number, number], words: string, look: string) =>
    out.push(`<text x="${at[0].toFixed(1)}" y="${at[1].toFixed(1)}" ${look}>${escaped(words)}</text>`);
  const region = (bands: [number, number][], top: number, height: number, fill: string) => {
    for (const [from, to] of bands) {
      out.push(`<rect x="${x(from).toFixed(1)}" y="${top}" width="${(x(to) - x(from)).toFixed(1)}" height="${height}" fill="${fill}"/>`);
    }
  };
  region(spec.parted, TOP, HEIGHT, LIGHT.parted);
  region(spec.outside, TOP, HEIGHT, 'url(#outside)');
  region(spec.caution, TOP - 8, 6, 'url(#caution)');
  text([LEFT, 32], spec.title, `font-size="18" font-weight="600" fill="${LIGHT.text}"`);
  text([LEFT, 54], spec.yLabel, `font-size="12" fill="${LIGHT.muted}"`);
  for (const each of (spec.yIsLogarithmic ? logarithmicTicks(low, high) : ticks(low, high, 6))) {
    out.push(`<path d="M${LEFT} ${y(each).toFixed(1)}H${right}" stroke="${LIGHT.grid}"/>`);
    text([LEFT - 8, y(each) + 4], tickText(each), `font-size="12" text-anchor="end" fill="${LIGHT.muted}"`);
  }
  for (const each of (spec.xIsLogarithmic ? logarithmicTicks(first, last) : ticks(first, last, 8))) {
    text([x(each), TOP + HEIGHT + 18], tickText(each), `font-size="12" text-anchor="middle" fill="${LIGHT.muted}"`);
  }
  out.push(`<path d="M${LEFT} ${TOP + HEIGHT}H${right}" stroke="${LIGHT.axis}"/>`);
  text([(LEFT + right) / 2, TOP + HEIGHT + 38], spec.xLabel, `font-size="12" text-anchor="middle" fill="${LIGHT.muted}"`);
  for (const level of spec.levels) {
    if (level.value < low || level.value > high) continue;
    out.push(`<path d="M${LEFT} ${y(level.value).toFixed(1)}H${right}" stroke="${LIGHT.muted}" stroke-dasharray="4 4"/>`);
    text([LEFT + 6, y(level.value) - 4], level.label, `font-size="11.5" fill="${LIGHT.muted}"`);
  }
  for (const line of spec.lines) {
    for (const area of areasOf(line)) {
      const edge = (values: number[]) => values.map((value, i) => `${x(area.x[i]!).toFixed(1)} ${y(value).toFixed(1)}`);
      out.push(`<path d="M${[...edge(area.high), ...edge(area.low).reverse()].join('L')}Z" fill="${colorOf(line.series, LIGHT)}" opacity="${opacityOf(line)}"/>`);
    }
  }
  for (const line of spec.lines) {
    let path = '';
    line.y.forEach((value, i) => {
      if (value === null) return;
      path += `${i === 0 || line.y[i - 1] === null ? 'M' : 'L'}${x(line.x[i]!).toFixed(1)} ${y(value).toFixed(1)}`;
    });
    const dash = DASHES[line.variant % DASHES.length]!.join(' ');
    if (!line.isMarksOnly) out.push(`<path d="${path}" fill="none" stroke="${colorOf(line.series, LIGHT)}" stroke-width="2" stroke-linejoin="round"${dash ? ` stroke-dasharray="${dash}"` : ''}/>`);
    if (!hasMarker(line.series)) continue;
    line.y.forEach((value, i) => {
      if (value === null) return;
      if (endsBranch(line, i)) out.push(`<path d="M${x(line.x[i]!).toFixed(1)} ${(y(value) - 8).toFixed(1)}v16" stroke="${colorOf(line.series, LIGHT)}" stroke-width="1.5"/>`);
      out.push(markerText(line, x(line.x[i]!), y(value), line.hollow[i] ?? false));
    });
  }
  const ends = spec.lines.flatMap((line) => {
    const end = line.label === '' ? null : lastOf(line);
    return end ? [{ line, y: y(end.y) }] : [];
  });
  const places = spread(ends.map((each) => each.y), 16, TOP + 6, TOP + HEIGHT - 6);
  ends.forEach((each, i) =>
    text([right + 12, places[i]! + 4], each.line.label, `font-size="12.5" font-weight="600" fill="${colorOf(each.line.series, LIGHT)}"`));
  const below = TOP + HEIGHT + 66;
  footer.forEach((words, i) =>
    text([LEFT, below + LINE_PITCH * i], words, `font-size="11.5" fill="${LIGHT.muted}"`));
  const height = below + LINE_PITCH * footer.length;
  const pattern = (id: string, color: string) =>
    `<pattern id="${id}" width="6" height="6" patternUnits="userSpaceOnUse"><path d="M0 6L6 0" stroke="${color}" opacity="0.6"/></pattern>`;
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${WIDTH}" height="${height}" viewBox="0 0 ${WIDTH} ${height}" font-family="system-ui, sans-serif">` +
    `<defs>${pattern('outside', LIGHT.outside)}${pattern('caution', LIGHT.caution)}</defs>` +
    `<rect width="100%" height="100%" fill="${LIGHT.background}"/>${out.join('\n')}</svg>\n`
  );
}

/** The picture with twice as many pixels as the drawing has units. */
export async function pngOf(svg: string): Promise<Blob> {
  const image = new Image();
  const address = URL.createObjectURL(new Blob([svg], { type: 'image/svg+xml' }));
  try {
    image.src = address;
    await image.decode();
    const canvas = document.createElement('canvas');
    canvas.width = 2 * image.naturalWidth;
    canvas.height = 2 * image.naturalHeight;
    canvas.getContext('2d')!.drawImage(image, 0, 0, canvas.width, canvas.height);
    return await new Promise((done, fail) =>
      canvas.toBlob((blob) => (blob ? done(blob) : fail(new Error('the picture cannot be made')))));
  } finally {
    URL.revokeObjectURL(address);
  }
}

export function save(name: string, content: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
