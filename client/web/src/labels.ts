import type { Label } from './api/types';

/** Labels of a text such as "project=axle, series=b"; a word without '=' is a key without a value. */
export const labelsOf = (text: string): Label[] =>
  text.split(',').map((each) => each.trim()).filter((each) => each !== '').map((each) => {
    const [key, ...value] = each.split('=');
    return { key: key!.trim(), value: value.join('=').trim() };
  });

export const labelText = ({ key, value }: Label): string => (value ? `${key}=${value}` : key!);
