import { useColors } from '../charts/theme';
import { colorOf, corners, hasMarker, MARKERS } from '../charts/spec';

/** The marker of a fluid; nothing of the same size if it is not on the plot (series -1). */
export function Swatch({ series }: { series: number }) {
  const colors = useColors();
  if (series < 0) return <svg class="marker" width="14" height="14" aria-hidden="true" />;
  const color = colorOf(series, colors);
  const shape = hasMarker(series) ? corners(MARKERS[series]!, 4) : null;
  return (
    <svg class="marker" width="14" height="14" viewBox="-7 -7 14 14" aria-hidden="true">
      {shape === null ? <circle r={hasMarker(series) ? 4 : 2} fill={color} /> : <polygon points={shape.map((each) => each.join(',')).join(' ')} fill={color} />}
    </svg>
  );
}
