import { useState } from 'preact/hooks';
import { url } from '../api/client';
import type { Spec } from '../charts/spec';
import { pngOf, save, svgOf } from '../charts/svg';
import { remarksOf, type Curve } from '../curve';
import { idOf, revisionIdOf } from '../format';
import { commandsOf, inputsOf, requestOfSimulations } from '../request';

interface CurveExportProps {
  spec: Spec;
  curves: Curve[];
  project: string;
}

/** What a reader needs to repeat the figure. */
function footerOf(curves: Curve[]): string[] {
  const first = curves[0]!.simulation;
  return [
    `Gear set ${revisionIdOf(first.gear_set_revision)}, surface ${revisionIdOf(first.surface_revision)}, vehicle ${revisionIdOf(first.vehicle_revision)}, ` +
      `sump ${[...new Set(curves.map((each) => each.simulation.sump_temperature_celsius ?? 40))].join(', ')} °C. Loss of the tooth contact only.`,
    `${first.result?.model_version ?? ''}; inputs ${curves.map((each) => `${revisionIdOf(each.simulation.lubricant_revision)} ${each.simulation.input_hash?.slice(0, 12)}`).join(', ')}`,
    ...remarksOf(curves).map((each) => `${each.words}, at ${each.speeds}`),
    ...(curves.some((each) => each.branchEnds.some((end) => end)) ? ['A line breaks where its branch of steady states ends: the response jumps.'] : []),
  ];
}

/** Everything that can be taken away from a figure. */
export function CurveExport({ spec, curves, project }: CurveExportProps) {
  const [copied, setCopied] = useState('');
  const copy = async (what: string, text: string) => {
    await navigator.clipboard.writeText(text);
    setCopied(what);
    setTimeout(() => setCopied(''), 2000);
  };
  const svg = () => svgOf(spec, footerOf(curves));
  const request = requestOfSimulations(curves.map((each) => each.simulation));
  return (
    <details class="menu">
      <summary class="button">Take away</summary>
      <div class="menu-body">
        <button onClick={() => save('curves.svg', new Blob([svg()], { type: 'image/svg+xml' }))}>Figure as SVG</button>
        <button onClick={() => void pngOf(svg()).then((png) => save('curves.png', png))}>Figure as PNG</button>
        {curves.map((curve) => (
          <a key={curve.simulation.name} class="button" download={`${idOf(curve.simulation.lubricant)}-${idOf(curve.simulation.name)}.csv`}
            href={url(curve.simulation.name!, { alt: 'csv' })}>All numbers of {idOf(curve.simulation.lubricant)} as CSV</a>
        ))}
        <button onClick={() => save('request.json', new Blob([JSON.stringify(curves.map(({ simulation }) => ({ ...inputsOf(simulation), inefficiency_curve: simulation.inefficiency_curve })), null, 2)], { type: 'application/json' }))}>Request as JSON</button>
        <button onClick={() => void copy('command', commandsOf(request, project).join('\n'))}>{copied === 'command' ? 'Copied' : 'Copy the command line'}</button>
        <button onClick={() => void copy('link', location.href)}>{copied === 'link' ? 'Copied' : 'Copy a link to this result'}</button>
        <pre class="command" aria-label="Command line">{commandsOf(request, project).join('\n')}</pre>
      </div>
    </details>
  );
}
