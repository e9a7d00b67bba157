import { OPTIONS, PRESETS, type Model, type Preset } from '../model';

/** Chooses the preset of the model. */
export function PresetChoice({ preset, onChange }: { preset: Preset; onChange: (preset: Preset) => void }) {
  return (
    <label>
      Model
      <select value={preset} title={PRESETS.find(([each]) => each === preset)![2]} onChange={(event) => onChange(event.currentTarget.value as Preset)}>
        {PRESETS.map(([value, words]) => <option key={value} value={value}>{words}</option>)}
      </select>
    </label>
  );
}

/** Chooses what a model leaves out. */
export function OptionChoice({ options, onChange }: { options: string[]; onChange: (options: string[]) => void }) {
  return (
    <>
      {OPTIONS.map(([name, words]) => (
        <label key={name} class="choice">
          <input type="checkbox" checked={options.includes(name)}
            onChange={() => onChange(options.includes(name) ? options.filter((each) => each !== name) : [...options, name])} />
          <span>{words}</span>
        </label>
      ))}
    </>
  );
}

/** Chooses the model of a request. */
export function ModelChoice<T extends Model>({ request, onChange }: { request: T; onChange: (request: T) => void }) {
  return (
    <>
      <PresetChoice preset={request.preset} onChange={(preset) => onChange({ ...request, preset })} />
      <details open={request.options.length > 0}>
        <summary>Model options</summary>
        <OptionChoice options={request.options} onChange={(options) => onChange({ ...request, options })} />
      </details>
    </>
  );
}
