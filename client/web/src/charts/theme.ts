import { useEffect, useState } from 'preact/hooks';
import { Store, useStore } from '../store';
import { DARK, LIGHT, type Colors } from './spec';

export type Theme = 'system' | 'light' | 'dark';

const stored = localStorage.getItem('theme');
export const theme = new Store<Theme>(stored === 'light' || stored === 'dark' ? stored : 'system');

const prefersDark = matchMedia('(prefers-color-scheme: dark)');

function apply(): void {
  const isDark = theme.value === 'dark' || (theme.value === 'system' && prefersDark.matches);
  document.documentElement.dataset['theme'] = isDark ? 'dark' : 'light';
}
theme.subscribe(() => {
  localStorage.setItem('theme', theme.value);
  apply();
});
prefersDark.addEventListener('change', apply);
apply();

/** The colors of the theme that is shown. */
export function useColors(): Colors {
  const chosen = useStore(theme);
  const [systemIsDark, setSystem] = useState(prefersDark.matches);
  useEffect(() => {
    const listen = () => setSystem(prefersDark.matches);
    prefersDark.addEventListener('change', listen);
    return () => prefersDark.removeEventListener('change', listen);
  }, []);
  return chosen === 'dark' || (chosen === 'system' && systemIsDark) ? DARK : LIGHT;
}
