import { useMemo, useState } from 'preact/hooks';
import { ApiError, change, get, session, url } from '../api/client';
import type { AppendCandidatesRequest, Campaign, Lubricant, Surface } from '../api/types';
import { conditionsOf } from '../campaign';
import { characterise, parametersOf, unitsOf, type Bases, type Present } from '../candidates';
import { inputWords } from '../inputs';
import { Missing } from '../components/missing';
import { Failure, Notice } from '../components/notice';
import { idOf } from '../format';
import { useLoaded, useSchema } from '../resources';
import { address, go } from '../router';
import { FluidChoice } from './candidate_fluids';
import { Estimate, Intake, TableForm, tableProblems, tableWords, useTable } from './candidate_table';

let checks = 0;

interface Known {
  campaign: Campaign;
  bases: Bases;
  present: Present;
}

const FIELDS = 'name,display_name,candidates,points,lubricant_revision,surface_revision,candidate_columns.path,candidate_attributes.name,candidate_attributes.texts,candidate_lubricants';

async function readKnown(name: string, signal: AbortSignal): Promise<Known> {
  const campaign = await get<Campaign>(url(name, { read_mask: FIELDS }), signal);
  const [lubricant, surface] = await Promise.all([get<Lubricant>(url(campaign.lubricant_revision!), signal), campaign.surface_revision ? get<Surface>(url(campaign.surface_revision), signal) : ({} as Surface)]);
  return {
    campaign, bases: { lubricant, surface },
    present: {
      paths: (campaign.candidate_columns ?? []).map((each) => each.path!),
      attributes: new Map((campaign.candidate_attributes ?? []).map((each) => [each.name!, (each.texts ?? []).length > 0 ? 'texts' : 'values'])),
    },
  };
}

/** Adds candidates to a campaign: a further table, or further lubricants if its candidates are lubricants. */
export function AppendCandidates({ name }: { name: string }) {
  const known = useLoaded((signal) => readKnown(name, signal), name);
  const schema = useSchema();
  const { campaign, bases, present } = known.value ?? {};
  const ofLubricants = (campaign?.candidate_lubricants ?? []).length > 0;
  const constraints = schema.value?.constraints;
  const parameters = useMemo(() => parametersOf(schema.value?.vocabularies), [schema.value]);
  const state = useTable(`table for ${name}`, bases, parameters, constraints, present);
  const [fluids, setFluids] = useState<string[]>([]);
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<unknown>(null);
  const isWhole = ofLubricants ? fluids.length > 0 : state.isWhole;
  const key = useMemo(() => `addition ${++checks}`, [state.candidates, fluids]);
  const check = useLoaded(async (signal) => {
    if (!isWhole) return null;
    const given = ofLubricants ? undefined : await characterise(state.candidates!, bases!, parameters, signal, present);
    const body: AppendCandidatesRequest = given ? { candidate_columns: given.columns, candidate_attributes: given.attributes }
      : { candidate_lubricants: fluids.map((each) => `lubricants/${each}`) };
    try {
      return { body, answer: await change<Campaign>('POST', `${url(name)}:append`, { ...body, validate_only: true }, signal) };
    } catch (refusal) {
      if (refusal instanceof ApiError && given) Object.assign(refusal, { candidates: given });
      throw refusal;
    }
  }, key);
  if (known.error !== undefined) return (known.error as { status?: number }).status === 404 ? <Missing /> : <Failure error={known.error} onRetry={known.reload} />;
  if (!campaign || !present) return <p class="muted">Loading …</p>;
  const refusal = check.error instanceof ApiError ? check.error : null;
  const { problems, elsewhere } = ofLubricants ? { problems: [], elsewhere: refusal?.violations ?? [] } : tableProblems(state, refusal);
  const fluidProblem = (id: string) => refusal?.violations.find((each) => each.field === `candidate_lubricants[${fluids.indexOf(id)}]`)?.description;
  const others = elsewhere.filter((each) => !/^candidate_lubricants\[\d+\]$/.test(each.field));
  const isReady = isWhole && !check.isStale && check.error === undefined && check.value != null;
  const words = ofLubricants ? (fluids.length === 0 ? 'Choose the fluids to be added.' : '') : tableWords(state, problems);
  const back = address(`/campaigns/${idOf(name)}`);
  const append = async (event: SubmitEvent) => {
    event.preventDefault();
    if (!isReady) return;
    setBusy(true);
    try {
      await change<Campaign>('POST', `${url(name)}:append`, check.value!.body);
      state.take(null);
      go(back);
    } catch (failure) {
      setProblem(failure);
      setBusy(false);
    }
  };
  return (
    <form onSubmit={(event) => void append(event)} noValidate>
      <div class="heading">
        <div>
          <h1>Add candidates to <a href={back}>{campaign.display_name || `campaign ${idOf(name)}`}</a></h1>
          <p class="muted">It has {campaign.candidates} candidates at {conditionsOf(campaign)} condition{conditionsOf(campaign) === 1 ? '' : 's'}. What is computed stays as it is.</p>
        </div>
        <button class="primary" disabled={!isReady || busy || session.value?.scope === 'read'}>{busy ? 'Adding …' : 'Add the candidates'}</button>
      </div>
      {problem !== null && <Failure error={problem} />}
      {(ofLubricants || state.table) && (
        <p role="status" class={isReady ? 'estimate' : 'estimate muted'}>
          {isReady ? <>Then <Estimate answer={check.value!.answer} ofNew /></> : words || (check.error !== undefined ? 'The request is refused.' : 'Checking …')}
        </p>
      )}
      {others.length > 0 && <Notice kind="error">{others.map((each) => <p key={each.field}>{each.field}: {each.description}</p>)}</Notice>}
      {check.error !== undefined && (refusal?.violations ?? []).length === 0 && <Failure error={check.error} onRetry={check.reload} />}
      {ofLubricants && <FluidChoice chosen={fluids} onChange={setFluids} problemOf={fluidProblem} taken={campaign.candidate_lubricants!.map(idOf)} />}
      {!ofLubricants && (
        <p class="small">
          The table states the same columns: {[...present.paths.map(inputWords), ...present.attributes.keys()].join('; ')}.
        </p>
      )}
      {!ofLubricants && !state.table && <Intake onTake={state.take} />}
      {!ofLubricants && state.table && (
        <>
          {state.columns.length > 0 && <TableForm table={state.table} columns={state.columns} parameters={parameters} unitsOf={(role) => unitsOf(role, constraints)} problems={problems} onChange={state.choose} />}
          <button type="button" onClick={() => state.take(null)}>Take the table away</button>
        </>
      )}
    </form>
  );
}
