import { useState } from 'preact/hooks';
import type { GearSet, Lubricant } from '../api/types';
import type { Violation } from '../api/client';
import { fluidsOf, shortTitle, type Curve } from '../curve';
import { idOf } from '../format';
import { type CurveRequest } from '../request';
import { titlesOf, useSchema } from '../resources';
import { celsius, readNumber, written } from '../units';
import { ModelChoice } from './model_choice';
import { Swatch } from './swatch';

interface ConditionsProps {
  request: CurveRequest;
  onChange: (request: CurveRequest) => void;
  lubricants: Lubricant[];
  gearSets: GearSet[];
  violations: Violation[];
  shown: Curve[];
}

/** The form of a curve: fluids, sumps, gear set, speeds, options. */
export function Conditions({ request, onChange, lubricants, gearSets, violations, shown }: ConditionsProps) {
  // The text of the field of sumps while it is edited: numbers alone have no comma at their end.
  const [typed, setTyped] = useState<string | null>(null);
  const titles = titlesOf(lubricants);
  const colored = fluidsOf(shown).map(idOf);
  const schema = useSchema();
  const range = (message: string, field: string): string => {
    const row = schema.value?.constraints?.find((each) => each.message === message && each.field === field);
    return row ? `${row.minimum} to ${row.maximum} ${row.unit}` : '';
  };
  const problemOf = (field: string) => violations.find((each) => each.field.endsWith(field))?.description;
  const chosen = new Map(request.fluids.map((each) => [idOf(each), each]));
  const toggle = (id: string) =>
    onChange({ ...request, fluids: chosen.has(id) ? request.fluids.filter((each) => idOf(each) !== id) : [...request.fluids, id] });
  const number = (key: 'first' | 'last' | 'step', words: string, field: string) => (
    <label>
      {words}
      <input type="number" step="any" value={request[key]} title={range('InefficiencyCurveStudy', field)}
        aria-invalid={problemOf(field) !== undefined}
        onInput={(event) => onChange({ ...request, [key]: event.currentTarget.valueAsNumber })} />
      {problemOf(field) && <span class="problem" role="alert">{problemOf(field)}</span>}
    </label>
  );
  return (
    <>
      <fieldset class="fluids">
        <legend>Fluids</legend>
        {lubricants.map((each) => {
          const id = idOf(each.name);
          const pinned = chosen.get(id);
          return (
            <label key={id} class="choice">
              <input type="checkbox" checked={pinned !== undefined} onChange={() => toggle(id)} />
              <Swatch series={colored.indexOf(id)} />
              <span>{shortTitle(titles.get(id)!)}{pinned?.includes('@') && pinned !== `${id}@${each.revision}` ? ` (revision ${pinned.split('@')[1]})` : ''}</span>
            </label>
          );
        })}
      </fieldset>
      <fieldset>
        <legend>Conditions</legend>
        <label>
          Sump, {celsius.symbol}
          <input value={typed ?? request.sumps.map((each) => written(each, celsius)).join(', ')} inputMode="decimal" title={`${range('Simulation', 'sump_temperature_celsius')}; several with commas between them`}
            aria-invalid={problemOf('sump_temperature_celsius') !== undefined}
            onInput={(event) => {
              setTyped(event.currentTarget.value);
              const sumps = event.currentTarget.value.split(/[,;]\s*|\s+/).filter((word) => word !== '').map((word) => readNumber(word, celsius)).filter((value) => !Number.isNaN(value));
              if (sumps.length > 0) onChange({ ...request, sumps });
            }}
            onBlur={() => setTyped(null)} />
          {problemOf('sump_temperature_celsius') && <span class="problem" role="alert">{problemOf('sump_temperature_celsius')}</span>}
        </label>
        <label>
          Gear set
          <select value={idOf(request.gearSet) || 'reference-axle'} onChange={(event) => onChange({ ...request, gearSet: event.currentTarget.value })}>
            {gearSets.map((each) => <option key={each.name} value={idOf(each.name)}>{each.display_name || idOf(each.name)}</option>)}
          </select>
        </label>
        <div class="triple" role="group" aria-label="Speeds">
          {number('first', 'From km/h', 'first_speed_kilometres_per_hour')}
          {number('last', 'to', 'last_speed_kilometres_per_hour')}
          {number('step', 'by', 'speed_step_kilometres_per_hour')}
        </div>
        <ModelChoice request={request} onChange={onChange} />
      </fieldset>
    </>
  );
}
