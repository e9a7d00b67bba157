import type { Constraint } from '../api/types';
import { baseValue, type Bases } from '../candidates';
import { inputWords } from '../inputs';
import { Entry } from '../components/entry';
import { Num } from '../components/num';
import { easyUnit, factorUnit, factorUnits, METHODS, type Design, type DesignProblem, type Factor } from '../design';
import { rangeText } from '../lubricant_fields';

/** The allowed range of a parameter, by the schema. */
const constraintOfParameter = (parameter: string, constraints: Constraint[] | undefined): Constraint | undefined =>
  constraints?.find((each) => each.field === parameter.replace(/^.*\./, '') && each.message !== 'LubricantMeasurements');

/** States a design: the server makes its candidates. */
export function DesignForm({ design, onChange, parameters, constraints, bases, problems }: {
  design: Design; onChange: (design: Design) => void; parameters: string[]; constraints: Constraint[] | undefined; bases: Bases | undefined; problems: DesignProblem[];
}) {
  const isGrid = design.method === 'GRID';
  const textsAt = (field: string) => problems.filter((each) => each.field === field).map((each) => each.text);
  const Texts = ({ field }: { field: string }) => <>{textsAt(field).map((text) => <span key={text} class="problem" role="alert">{text}</span>)}</>;
  const put = (k: number, next: Partial<Factor>) => onChange({ ...design, factors: design.factors.map((each, i) => (i === k ? { ...each, ...next } : each)) });
  const easy = (parameter: string) => easyUnit(parameter, bases && baseValue(bases, parameter), constraints).symbol;
  const free = parameters.filter((each) => !design.factors.some((factor) => factor.parameter === each));
  const add = (parameter: string) =>
    onChange({ ...design, factors: [...design.factors, { parameter, minimum: '', maximum: '', unit: easy(parameter), isLogarithmic: false, levels: '3' }] });
  const number = (field: string, label: string, value: string, onText: (text: string) => void, full?: string) => (
    <label>{label}
      <Entry inputMode="decimal" value={value} aria-label={full} aria-invalid={textsAt(field).length > 0} onChange={(event) => onText(event.currentTarget.value)} />
      <Texts field={field} />
    </label>
  );
  const options = (kind: string, label: string, list: string[]) => (
    <optgroup label={label}>{list.filter((each) => each.startsWith(kind)).map((each) => <option key={each} value={each}>{inputWords(each)}</option>)}</optgroup>
  );
  return (
    <div class="design">
      <fieldset class="grid">
        <legend>Design</legend>
        <label>Method
          <select value={design.method} onChange={(event) => onChange({ ...design, method: event.currentTarget.value as Design['method'] })}>
            {METHODS.map(([id, words]) => <option key={id} value={id}>{words}</option>)}
          </select>
          <Texts field="method" />
        </label>
        {!isGrid && number('count', 'Candidates', design.count, (count) => onChange({ ...design, count }))}
        {!isGrid && number('seed', 'Seed of the random numbers', design.seed, (seed) => onChange({ ...design, seed }))}
        <p class="small">{METHODS.find(([id]) => id === design.method)![2]}</p>
      </fieldset>
      <Texts field="factors" />
      {design.factors.map((factor, k) => {
        const unit = factorUnit(factor, constraints);
        const constraint = constraintOfParameter(factor.parameter, constraints);
        const usual = bases && baseValue(bases, factor.parameter);
        return (
          <fieldset key={factor.parameter} class="factor" aria-label={`Factor ${k + 1}`}>
            <label class="parameter">Factor
              <select value={factor.parameter} aria-invalid={textsAt(`factors[${k}].parameter`).length > 0}
                onChange={(event) => put(k, { parameter: event.currentTarget.value, minimum: '', maximum: '', unit: easy(event.currentTarget.value) })}>
                {options('lubricant.', 'Lubricant', [factor.parameter, ...free])}
                {options('surface.', 'Surface', [factor.parameter, ...free])}
              </select>
              <Texts field={`factors[${k}].parameter`} />
            </label>
            {number(`factors[${k}].minimum`, 'From', factor.minimum, (minimum) => put(k, { minimum }), `${inputWords(factor.parameter)}, least`)}
            {number(`factors[${k}].maximum`, 'to', factor.maximum, (maximum) => put(k, { maximum }), `${inputWords(factor.parameter)}, greatest`)}
            {factorUnits(factor.parameter, constraints).length > 1 || unit.symbol !== '' ? (
              <label>Unit
                <select value={unit.symbol} onChange={(event) => put(k, { unit: event.currentTarget.value })}>
                  {factorUnits(factor.parameter, constraints).map((each) => <option key={each.symbol}>{each.symbol}</option>)}
                </select>
              </label>
            ) : <span />}
            <label>Divided
              <select value={factor.isLogarithmic ? 'log' : 'linear'} onChange={(event) => put(k, { isLogarithmic: event.currentTarget.value === 'log' })}>
                <option value="linear">evenly</option><option value="log">by ratios</option>
              </select>
              <Texts field={`factors[${k}].scale`} />
            </label>
            {isGrid && number(`factors[${k}].levels`, 'Levels', factor.levels, (levels) => put(k, { levels }), `${inputWords(factor.parameter)}, levels`)}
            <button type="button" class="quiet" onClick={() => onChange({ ...design, factors: design.factors.filter((_, i) => i !== k) })}>Remove<span class="hidden"> {inputWords(factor.parameter)}</span></button>
            <p class="small about">
              {usual !== undefined && <>The base has <Num value={usual} unit={unit} />{unit.symbol && ` ${unit.symbol}`}; </>}allowed {rangeText(constraint, unit)}{unit.symbol && ` ${unit.symbol}`}
              {!isGrid && factor.minimum === '' && factor.maximum === '' && '. Without a range: spread by the standard uncertainty that the base states.'}
            </p>
          </fieldset>
        );
      })}
      {design.factors.length === 0 && !isGrid && <p class="small">Without factors, the service spreads all parameters whose standard uncertainty the base states.</p>}
      <label class="add-factor">Add a factor
        <select value="" onChange={(event) => { add(event.currentTarget.value); event.currentTarget.value = ''; }}>
          <option value="">which parameter?</option>
          {options('lubricant.', 'Lubricant', free)}
          {options('surface.', 'Surface', free)}
        </select>
      </label>
    </div>
  );
}
