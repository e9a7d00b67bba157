import type { Label } from './api/types';

/** Labels of a text such as "project=axle, series=b"; a word without '=' is a key without a value. */
export const labelsOf = (text: string): Label[] =>
  text.split(',').map((each) => each.trim()).filter((each) => each !== '').map((each) => {
    const [key, ...value] = each.split('=');
    return { key: key!.trim(), value: value.join('=').trim() };
  });

export const labelText = ({ key, value }: Label): string => (value ? `${key}=${value}` : key!);

/** The filter of a label: "project=axle", or of a key alone: "project". */
export function filterOfLabel(label: string | null): string | undefined {
  if (!label) return undefined;
  const [key, ...value] = label.split('=');
  return value.length > 0 ? `labels.${key} = ${JSON.stringify(value.join('='))}` : `labels.${key}:*`;
}

/** Returns true if one of the labels is this one; of a key alone: has this key. */
export const hasLabel = (labels: Label[] | undefined, label: string): boolean =>
  (labels ?? []).some((each) => each.key === label || labelText(each) === label);
