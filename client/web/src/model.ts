import type { ModelOptions } from './api/types';

export type Preset = 'RECOMMENDED' | 'PAPER';

/** The model of a request: a preset, and what departs from it. */
export interface Model {
  preset: Preset;
  options: string[]; // of ModelOptions that are true; "-name": false
}

/** What a form can leave out of the model. */
export const OPTIONS: [string, string][] = [
  ['isothermal', 'Isothermal: contact as warm as its inlet'],
  ['newtonian', 'Newtonian: no shear thinning'],
  ['no_limiting_shear_stress', 'No limiting shear stress'],
  ['no_boundary_friction', 'No boundary friction'],
];

export const PRESETS: [Preset, string, string][] = [
  ['RECOMMENDED', 'recommended', 'With shear heating of the inlet, and boundary friction where the film vanishes.'],
  ['PAPER', 'paper', 'As published and corrected, to compare with the publication: not to choose oils by.'],
];

/** Options that are true in the recommended model unless they are set. */
const OF_PRESET = ['inlet_shear_heating', 'closed_load_sharing'];

export const modelOf = (options: ModelOptions | undefined): Model => {
  const preset = options?.preset === 'PAPER' ? 'PAPER' : 'RECOMMENDED';
  return {
    preset,
    options: Object.entries(options ?? {}).flatMap(([name, value]) =>
      (typeof value !== 'boolean' || value === (preset === 'RECOMMENDED' && OF_PRESET.includes(name)) ? [] : [value ? name : `-${name}`])),
  };
};

export const modelRequestOf = (query: URLSearchParams): Model => ({
  preset: query.get('model') === 'paper' ? 'PAPER' : 'RECOMMENDED', options: (query.get('opt') ?? '').split(',').filter((each) => each !== ''),
});

export const modelQueryOf = ({ preset, options }: Model): Record<string, string | undefined> =>
  ({ model: preset === 'PAPER' ? 'paper' : undefined, opt: options.join(',') || undefined });

/** The field of a request; empty if nothing departs from the service's default. */
export function modelBodyOf({ preset, options }: Model): { model_options?: ModelOptions } {
  if (preset === 'RECOMMENDED' && options.length === 0) return {};
  return {
    model_options: {
      ...(preset === 'PAPER' ? { preset } : {}),
      ...Object.fromEntries(options.map((each) => [each.replace(/^-/, ''), !each.startsWith('-')])),
    },
  };
}

/** The flags of the command line. */
export const modelFlagsOf = ({ preset, options }: Model): string[] => [
  ...(preset === 'PAPER' ? ['--preset', 'paper'] : []),
  ...options.map((each) => (each.startsWith('-') ? `--${each.slice(1).replaceAll('_', '-')}=false` : `--${each.replaceAll('_', '-')}`)),
];

/** "isothermal, no inlet shear heating" */
export const optionWords = (options: string[]): string => options.map((each) => each.replace(/^-/, 'no ').replaceAll('_', ' ')).join(', ');
