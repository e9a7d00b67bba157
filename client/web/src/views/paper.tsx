import { useState } from 'preact/hooks';
import { session } from '../api/client';
import type { InefficiencyCurveStudy, Simulation } from '../api/types';
import { Failure } from '../components/notice';
import { address } from '../router';
import { run } from './home';

const STUDY: InefficiencyCurveStudy = { first_speed_kilometres_per_hour: 20, last_speed_kilometres_per_hour: 140, speed_step_kilometres_per_hour: 2.5 };

const curve = (fluid: number, more: Partial<Simulation> = {}, study: InefficiencyCurveStudy = {}): Simulation =>
  ({
    lubricant: `lubricants/paper-fluid-${fluid}`, sump_temperature_celsius: 40, ...more,
    model_options: { preset: 'PAPER', ...more.model_options }, inefficiency_curve: { ...STUDY, ...study },
  });
const FLUIDS = [curve(1), curve(2), curve(3)];
const SUMPS = [10, 40, 90].map((sump) => curve(1, { sump_temperature_celsius: sump }));

/** A figure of the paper: curves of an axle with the quantity that they show, or the address of a rig. */
interface Figure {
  number: number;
  title: string;
  bodies?: Simulation[];
  quantity?: string;
  rig?: string;
}

const THREE = 'paper-fluid-1,paper-fluid-2,paper-fluid-3';
const FIGURES: Figure[] = [
  { number: 5, title: 'Traction of Shell T9 on a ball-on-disc machine, thermal and isothermal', rig: '/rigs?f=shell-t9&load=38,154&t=25&radius=12.7&model=paper&opt=isothermal' },
  { number: 6, title: 'Least and greatest dynamic transmission error of lubricant 1, speed rising and falling', bodies: [curve(1), curve(1, {}, { direction: 'SWEEP_DIRECTION_DOWN' })], quantity: 'dte' },
  { number: 7, title: 'Friction torque on the pinion, lubricant 1', bodies: [curve(1)], quantity: 'torque' },
  { number: 8, title: 'Ratio of boundary to viscous friction of the three lubricants', bodies: FLUIDS, quantity: 'boundary' },
  { number: 9, title: 'Central film thickness of the three lubricants by optical interferometry', rig: `/rigs?kind=film&f=${THREE}&model=paper` },
  { number: 10, title: 'Inefficiency of lubricant 1, isothermal and thermal', bodies: [curve(1), curve(1, { model_options: { isothermal: true } })] },
  { number: 11, title: 'Temperature of the hottest contact, lubricant 1, three sump temperatures', bodies: SUMPS, quantity: 'temperature' },
  { number: 12, title: 'Inefficiency of lubricant 1 at three sump temperatures', bodies: SUMPS },
  { number: 13, title: 'Inefficiency of the three lubricants', bodies: FLUIDS },
  { number: 14, title: 'Traction of the three lubricants on a ball-on-disc machine', rig: `/rigs?f=${THREE}&load=35.2&speed=2.5&model=paper` },
  { number: 15, title: 'Inefficiency of lubricant 1, Newtonian and non-Newtonian', bodies: [curve(1), curve(1, { model_options: { newtonian: true } })] },
];

/** The figures of the paper, each a view of this server with the conditions set. */
export function Paper() {
  const [problem, setProblem] = useState<unknown>(null);
  const [busy, setBusy] = useState(0);
  const open = async (figure: Figure) => {
    setBusy(figure.number);
    try {
      await run(figure.bodies!, [], figure.quantity);
    } catch (error) {
      setProblem(error);
    } finally {
      setBusy(0);
    }
  };
  return (
    <>
      <h1>The figures of the paper</h1>
      <p class="muted">
        Paouris, Rahmani, Theodossiades, Rahnejat, Hunt and Barton (2018), by the paper's model. What the paper states about each figure,
        and whether it holds, is printed by <code>tribodyn paper --output paper</code>.
      </p>
      {problem !== null && <Failure error={problem} />}
      <ol class="places paper">
        {FIGURES.map((figure) => (
          <li key={figure.number}>
            <span class="count">Figure {figure.number}</span>
            {figure.rig ? <a href={address('') + figure.rig}>{figure.title}</a> : (
              <button class="link" disabled={busy !== 0 || session.value?.scope === 'read'} onClick={() => void open(figure)}>{figure.title}{busy === figure.number && ' …'}</button>
            )}
            <span class="muted">{figure.rig ? 'a ball on a disc' : `${figure.bodies!.length} curve${figure.bodies!.length > 1 ? 's' : ''} over speed`}</span>
          </li>
        ))}
      </ol>
    </>
  );
}
