import { url } from '../api/client';
import type { Spec } from '../charts/spec';
import { remarksOf, type Curve } from '../curve';
import { idOf, revisionIdOf } from '../format';
import { sumpText } from '../units';
import { remarkLines } from '../validity';
import { TakeAway } from './take_away';
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
      `sump ${[...new Set(curves.map((each) => sumpText(each.simulation.sump_temperature_celsius)))].join(', ')}. Loss of the tooth contact only.`,
    `${first.result?.model_version ?? ''}; inputs ${curves.map((each) => `${revisionIdOf(each.simulation.lubricant_revision)} ${each.simulation.input_hash?.slice(0, 12)}`).join(', ')}`,
    ...remarkLines(remarksOf(curves)),
    ...(curves.some((each) => each.branchEnds.some((end) => end)) ? ['A line breaks where its branch of steady states ends: the response jumps.'] : []),
  ];
}

/** Everything that can be taken away from curves. */
export function CurveExport({ spec, curves, project }: CurveExportProps) {
  const simulations = curves.map((each) => each.simulation);
  return (
    <TakeAway name="curves" spec={spec} footer={footerOf(curves)}
      requests={simulations.map((simulation) => ({ ...inputsOf(simulation), inefficiency_curve: simulation.inefficiency_curve }))}
      commands={commandsOf(requestOfSimulations(simulations), project)}>
      {simulations.map((simulation) => (
        <a key={simulation.name} class="button" download={`${idOf(simulation.lubricant)}-${idOf(simulation.name)}.csv`}
          href={url(simulation.name!, { alt: 'csv' })}>All numbers of {idOf(simulation.lubricant)} as CSV</a>
      ))}
    </TakeAway>
  );
}
