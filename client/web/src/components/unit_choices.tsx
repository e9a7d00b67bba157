import { useState } from 'preact/hooks';
import { useStore } from '../store';
import { UNIT_CHOICES, units, type Unit, type UnitKind } from '../units';

/** The units of all views, chosen in one place and kept in this browser. */
export function UnitChoices() {
  const present = useStore(units);
  const [isOpen, setOpen] = useState(false);
  const choice = (kind: UnitKind) => {
    const all: Unit[] = UNIT_CHOICES[kind].units;
    return (
      <label key={kind}>
        {UNIT_CHOICES[kind].label}
        <select aria-label={`Unit: ${UNIT_CHOICES[kind].label}`} value={present[kind] ?? all[0]!.symbol}
          onChange={(event) => units.set({ ...present, [kind]: event.currentTarget.value })}>
          {all.map((each) => <option key={each.symbol}>{each.symbol}</option>)}
        </select>
      </label>
    );
  };
  return (
    <details class="menu" onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary class="button quiet">Units</summary>
      {isOpen && <div class="menu-body unit-choices">{(Object.keys(UNIT_CHOICES) as UnitKind[]).map(choice)}</div>}
    </details>
  );
}
