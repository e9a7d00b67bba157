// Campaigns: what is followed and stopped, and how a reader finds candidates among many.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { campaignOf, foreignNumbers, launch, newPage, newTab, output, Server, signIn, TRIBODYN } from './harness.mjs';

let browser;
let server;
let page;
before(async () => {
  browser = await launch();
  server = await new Server().start();
  page = await newPage(browser, server);
  await page.goto(server.address);
  await signIn(page, server.token);
});
after(async () => {
  await browser?.close();
  await server?.remove();
});

/** A campaign of some seconds. */
const slowCampaign = {
  display_name: 'slow', lubricant: 'lubricants/paper-fluid-1', tolerance: 1e-5,
  candidate_columns: [{ path: 'lubricant.pressure_viscosity_coefficient_per_pascal', values: Array.from({ length: 30_000 }, (_, i) => 1.2e-8 + 3e-13 * i) }],
  conditions: [{ speed_kilometres_per_hour: 72 }],
};

test('a campaign is followed, paused, resumed and cancelled in the list', async () => {
  const { name } = await server.call('POST', '/v1/campaigns', slowCampaign);
  await page.goto(`${server.address}/campaigns`);
  const state = page.locator('.state');
  const stateOf = async () => (await server.call('GET', `/v1/${name}`)).state;
  await page.waitForFunction(() => document.querySelector('.state progress')?.value > 0);
  await page.getByRole('button', { name: 'Pause campaign 1' }).click();
  await page.locator('.state.paused').waitFor();
  assert.equal(await stateOf(), 'PAUSED');
  const done = await state.locator('progress').evaluate((element) => element.value);
  await page.getByRole('button', { name: 'Resume campaign 1' }).click();
  await page.waitForFunction((before) => document.querySelector('.state progress')?.value > before, done);
  await page.getByRole('button', { name: 'Cancel campaign 1' }).click();
  await page.locator('.state.cancelled').waitFor();
  assert.equal(await stateOf(), 'CANCELLED');
});

test('a campaign whose budget is spent says so and goes on without it', async () => {
  const { name } = await server.call('POST', '/v1/campaigns', campaignOf(1500, { budget: { points: 10 } }));
  await page.goto(`${server.address}/${name}`);
  await page.locator('.notice.caution').waitFor();
  assert.equal((await server.call('GET', `/v1/${name}`)).stop.reason, 'BUDGET_SPENT');
  await page.getByRole('button', { name: 'Resume without a budget' }).click();
  await page.waitForFunction(() => /(\d+) of \1 rows are computed/.test(document.querySelector('.campaign-progress').textContent));
  assert.equal((await server.call('GET', `/v1/${name}`)).state, 'SUCCEEDED');
});

test('a campaign that cannot be written is stalled, with the reason, until it goes on', async (scenario) => {
  const { name } = await server.call('POST', '/v1/campaigns', slowCampaign);
  const tab = await newTab(page.context(), server);
  scenario.after(() => tab.close());
  const stalled = { reason: 'STORE_FAILED', message: 'The disk is full.' };
  const event = { name, kind: 'STATE_CHANGE', state: 'RUNNING', points: 30_000, points_done: 7, stalled };
  // No disk is full here: what the server says is changed on its way.
  await tab.route('**/v1/campaigns?*', async (route) => {
    const body = await (await route.fetch()).json();
    body.campaigns.find((each) => each.name === name).stalled = stalled;
    await route.fulfill({ json: body });
  });
  await tab.route(`**/v1/${name}:watch*`, (route) => route.fulfill({ contentType: 'text/event-stream', body: `retry: 100\ndata: ${JSON.stringify(event)}\n\n` }));
  await tab.goto(`${server.address}/campaigns`);
  const row = tab.locator('tr', { hasText: stalled.message });
  await row.locator('.state.stalled').waitFor();
  await row.getByRole('link', { name: 'slow' }).click();
  await tab.locator('.notice.caution', { hasText: stalled.message }).waitFor();
  await tab.locator('.campaign-progress .state.stalled').waitFor();
  delete event.stalled;
  await tab.locator('.campaign-progress .state.stalled').waitFor({ state: 'detached' });
  assert.equal(await tab.getByText(stalled.message).count(), 0);
  await server.call('POST', `/v1/${name}:cancel`, {});
});

/** Waits until a campaign has ended and shows the page anew, which then has all rows. */
async function complete(name) {
  while ((await server.call('GET', `/v1/${name}`)).state === 'RUNNING') await new Promise((done) => setTimeout(done, 50));
  await page.reload();
  await page.getByText('180 of 180 rows are computed').waitFor();
}

test('candidates that cannot be told apart share the first rank, and one becomes a fluid', async () => {
  const { name } = await server.call('POST', '/v1/campaigns', campaignOf(30));
  await page.goto(`${server.address}/${name}`);
  await complete(name);
  const ranks = () => page.locator('.ranking tbody tr td:first-child').allTextContents();
  await page.locator('.ranking tbody tr').nth(29).waitFor();
  assert.deepEqual((await ranks()).slice(0, 3), ['1', '2', '3']);
  assert.deepEqual(await foreignNumbers(page), []);
  const body = campaignOf(30);
  const uncertainty = { name: 'pressure_viscosity_coefficient_per_pascal.uncertainty', values: body.candidate_columns[0].values.map((each) => 0.15 * each) };
  const uncertain = await server.call('POST', '/v1/campaigns', { ...body, candidate_attributes: [...body.candidate_attributes, uncertainty] });
  await page.goto(`${server.address}/${uncertain.name}`);
  await complete(uncertain.name);
  await page.getByText('1=', { exact: true }).nth(1).waitFor();
  const answer = await server.call('POST', `/v1/${uncertain.name}:rank`, { count: 100, objective: { figure: { column: 'inefficiency_energy_mean_percent' } } });
  await page.getByText(answer.not_included).waitFor();
  assert.equal((await ranks()).filter((each) => each === '1=').length, answer.candidates.filter((each) => each.comparison?.tied).length);
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByRole('button', { name: '0', exact: true }).click();
  await page.getByLabel('Id of a new fluid and surface').fill('candidate-0');
  await page.getByRole('button', { name: 'Make it a fluid' }).click();
  await page.waitForURL(/\/fluids\/candidate-0$/);
  const fluid = await server.call('GET', '/v1/lubricants/candidate-0');
  assert.equal(fluid.pressure_viscosity_coefficient_per_pascal, 1.2e-8);
  assert.equal((await server.call('GET', '/v1/surfaces/candidate-0')).asperity_friction_coefficient, 0.08);
});

test('the front of two objectives and the effects of all columns are those of the service', async () => {
  const { name } = await server.call('POST', '/v1/campaigns', campaignOf(30, { contact_figures: true }));
  await page.goto(`${server.address}/${name}?view=pareto&other=-film_ratio_minimum.MINIMUM`);
  await complete(name);
  await page.getByText(/(are|is) beaten by none in both/).waitFor();
  const answer = await server.call('POST', `/v1/${name}:findPareto`, {
    second: { figure: { column: 'film_ratio_minimum', aggregate: 'MINIMUM' }, wants_most: true },
  });
  const members = page.getByRole('region', { name: 'The front' }).locator('tbody tr');
  assert.equal(await members.count(), answer.total_size);
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByRole('button', { name: 'Main effects' }).click();
  await page.getByRole('table', { name: 'Main effects' }).waitFor();
  assert.match(await page.getByRole('table', { name: 'Main effects' }).locator('tbody th').first().textContent(), /Pressure-viscosity coefficient/);
  assert.deepEqual(await foreignNumbers(page), []);
});

test('rows are ordered by a column, and every number is one of the service', async () => {
  const { name } = await server.call('POST', '/v1/campaigns', campaignOf(30));
  await page.goto(`${server.address}/${name}?view=rows`);
  await complete(name);
  await page.getByRole('button', { name: 'Mesh loss', exact: true }).click();
  await page.waitForURL(/order=mesh_loss_power_watts/);
  const losses = () => page.locator('.rows tbody tr').evaluateAll((rows) => rows.map((row) => Number(row.querySelectorAll('[data-unit="W"]')[0].dataset.value)));
  const ascending = await losses();
  assert.equal(ascending.length, 30);
  assert.deepEqual(ascending, [...ascending].sort((a, b) => a - b));
  await page.getByLabel('Condition').selectOption({ label: '110 km/h, 90 °C' });
  await page.waitForURL(/at=5/);
  assert.notDeepEqual(await losses(), ascending);
  const read = await server.call('GET', `/v1/${name}:read?alt=columns&columns=mesh_loss_power_watts`);
  const last = read.columns.mesh_loss_power_watts.filter((_, row) => row % 6 === 5);
  assert.deepEqual(await losses(), last.sort((a, b) => a - b));
  assert.deepEqual(await foreignNumbers(page), []);
});

test('a stroke along an axis keeps the rows that pass there, and the address keeps the range', async () => {
  const { name } = await server.call('POST', '/v1/campaigns', campaignOf(30));
  await page.goto(`${server.address}/${name}?view=parallel`);
  await complete(name);
  const axis = page.locator('[data-axis="cost_euros_per_kilogram"] .handle');
  await axis.waitFor();
  const box = await axis.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height - 2, { steps: 4 });
  await page.mouse.up();
  await page.waitForURL(/b=cost_euros_per_kilogram/);
  await page.getByText('15 of 30 rows are within the ranges').waitFor();
  await page.reload();
  await page.getByText('15 of 30 rows are within the ranges').waitFor();
  await page.getByLabel('Cost euros per kilogram, greatest').fill('5.5');
  await page.getByLabel('Cost euros per kilogram, greatest').press('Enter');
  await page.getByText('4 of 30 rows are within the ranges').waitFor();
  await page.getByRole('button', { name: 'Table' }).click();
  await page.waitForFunction(() => document.querySelectorAll('.rows tbody tr').length === 4);
  await page.getByRole('button', { name: 'Show all rows' }).click();
  await page.waitForFunction(() => document.querySelectorAll('.rows tbody tr').length === 30);
});

test('a click on a dot opens its candidate, and the rows can be taken away', async () => {
  const { name } = await server.call('POST', '/v1/campaigns', campaignOf(30));
  await page.goto(`${server.address}/${name}?view=plot&x=cost_euros_per_kilogram&y=mesh_loss_power_watts&color=additive`);
  await complete(name);
  const plot = await page.locator('.scatter').boundingBox();
  // Candidate 0 is the leftmost dot, a twentieth of the span from the axis: the pointer goes up there.
  const left = plot.x + 56 + ((plot.width - 70) * 0.05) / 1.1;
  for (let top = plot.y + plot.height - 50; top > plot.y && !page.url().includes('c='); top -= 8) await page.mouse.click(left, top);
  await page.getByRole('heading', { name: 'Candidate 0' }).waitFor();
  await page.getByText('additive A').last().waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByText('Take away').click();
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByText('All rows as CSV').click()]);
  const lines = readFileSync(await file.path(), 'utf8').trim().split('\n');
  assert.equal(lines.length, 181);
  const command = await page.getByLabel('Command line').textContent();
  const printed = await output(TRIBODYN, ['--server', `unix:${server.folder}/socket`, ...command.split(' ').slice(1)]);
  assert.equal(printed.trim().split('\n').length, 181);
});

/** The form of a new campaign, without a table that another test left in it. */
async function openForm() {
  await page.evaluate(() => sessionStorage.clear());
  await page.goto(`${server.address}/campaigns/new`);
}

const candidatesFile = (name, text) => ({ name, mimeType: 'text/csv', buffer: Buffer.from(text) });

test('a dropped table becomes a campaign whose points and time the service counts', async () => {
  await page.goto(`${server.address}/campaigns`);
  await page.getByRole('link', { name: 'New campaign' }).click();
  await page.locator('.drop input').setInputFiles(candidatesFile('friction modifiers.csv',
    'name;alpha* [1/GPa];surface.asperity_friction_coefficient;additive;cost_euros_per_kilogram\nA-1;14,5;0,11;A;4\nA-2;;0,1;A;4,5\nB-1;16;0,08;"B; new";5\n'));
  await page.getByText('3 candidates at 12 conditions are 36 points').waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByLabel('Speeds, km/h').fill('30, 70');
  await page.getByLabel('Speeds, km/h').press('Tab');
  await page.getByText('3 candidates at 4 conditions are 12 points').waitFor();
  await page.getByLabel('Film, pressure and temperature of the contacts').check();
  await page.getByLabel('Sensitivity by Asperity friction coefficient').check();
  await page.waitForURL(/speeds=30,70&contact=1&by=surface.asperity_friction_coefficient/);
  await page.reload();
  await page.getByText('3 candidates at 4 conditions are 12 points').waitFor();
  await page.getByRole('button', { name: 'Create the campaign' }).click();
  await page.getByText('12 of 12 rows are computed').waitFor();
  const name = new URL(page.url()).pathname.slice(1);
  const campaign = await server.call('GET', `/v1/${name}?view=CAMPAIGN_VIEW_FULL`);
  const base = await server.call('GET', '/v1/lubricants/paper-fluid-1');
  assert.equal(campaign.display_name, 'friction modifiers');
  assert.deepEqual(campaign.candidate_columns, [
    { path: 'lubricant.pressure_viscosity_coefficient_per_pascal', values: [1.45e-8, base.pressure_viscosity_coefficient_per_pascal, 1.6e-8] },
    { path: 'surface.asperity_friction_coefficient', values: [0.11, 0.1, 0.08] },
  ]);
  assert.deepEqual(campaign.candidate_attributes.map(({ name, texts, values }) => [name, texts, values]), [
    ['name', ['A-1', 'A-2', 'B-1'], []], ['additive', ['A', 'A', 'B; new'], []], ['cost_euros_per_kilogram', [], [4, 4.5, 5]],
  ]);
  assert.equal(campaign.contact_figures, true);
  await page.getByRole('button', { name: 'B-1', exact: true }).waitFor();
});

test('a mistake in a table of candidates is named in its cell, whoever finds it', async () => {
  page.expect(400, 'campaigns?validate_only');
  await openForm();
  await page.getByLabel('Or paste it from a spreadsheet').fill('name\trelaxation_time\tdensity_slope\tweight\nA\t2\tx\t1\nB\t3\t-0.6\t2\nC\t4\n');
  const cell = (row, column) => page.getByRole('region', { name: 'Table of candidates' }).locator('tbody tr', { has: page.getByRole('rowheader', { name: row, exact: true }) }).locator('td').nth(column);
  await cell('2', 2).getByText('"x" is not a number').waitFor();
  await page.getByText('has 2 cells; the header has 4').waitFor();
  await page.locator('th', { hasText: 'relaxation_time' }).getByText('choose its unit').waitFor();
  assert.ok(await page.getByRole('button', { name: 'Create the campaign' }).isDisabled());
  await page.getByRole('button', { name: 'Take the table away' }).click();
  await page.getByLabel('Or paste it from a spreadsheet').fill('name\trelaxation_time\tweight\nA\t2\t1\nB\t30000000\t200\n');
  await page.getByLabel('Unit of relaxation_time').selectOption('µs');
  await cell('3', 1).getByText(/30 s; allowed: 0 to 10 s/).waitFor();
  await page.getByLabel('What relaxation_time is').selectOption('rides along');
  await page.getByText('No column is a parameter or of a data sheet').waitFor();
  await page.getByLabel('What weight is').selectOption('Thermal conductivity');
  await cell('3', 2).getByText(/allowed: /).waitFor();
  await page.getByLabel('Speeds, km/h').fill('30, 7000');
  await page.getByLabel('Speeds, km/h').press('Tab');
  await page.locator('.panel .problem', { hasText: 'allowed' }).waitFor();
});

test('a table whose parameters the service would estimate is refused: it cannot carry their uncertainty', async () => {
  page.expect(400, 'lubricants:batchCreate');
  await openForm();
  await page.getByLabel('Or paste it from a spreadsheet').fill('name\tKV40\tKV100\tdensity\nA\t103\t15.1\t868\nB\t9.5\t140\t862\n');
  await page.getByText('140 mm2/s at 100 C must be below that at 40 C').waitFor();
  await page.getByRole('button', { name: 'Take the table away' }).click();
  await page.getByLabel('Or paste it from a spreadsheet').fill('name\tKV40\tKV100\tdensity\nA\t103\t15.1\t868\nB\t95\t14.1\t862\n');
  await page.locator('.notice.error', { hasText: 'screen them as fluids' }).waitFor();
  assert.ok(await page.getByRole('button', { name: 'Create the campaign' }).isDisabled());
});

test('a column has the unit of the schema, whatever its name ends in', async () => {
  const { name } = await server.call('POST', '/v1/campaigns', {
    lubricant: 'lubricants/paper-fluid-1', contact_figures: true, conditions: [{ speed_kilometres_per_hour: 60 }],
    candidate_columns: [
      { path: 'lubricant.thermal_conductivity_watts_per_metre_kelvin', values: [0.14, 0.154] },
      { path: 'lubricant.density_slope_kilograms_per_cubic_metre_kelvin', values: [-0.65, -0.6] },
      { path: 'lubricant.pressure_viscosity_coefficient_per_pascal', values: [1.5e-8, 1.6e-8] },
      { path: 'lubricant.vogel_temperature_coefficient_kelvin', values: [940, 945] },
      { path: 'surface.composite_rms_height_metres', values: [4e-7, 5e-7] },
    ],
  });
  await page.goto(`${server.address}/${name}?view=rows`);
  await page.getByText('2 of 2 rows are computed').waitFor();
  await page.reload();
  await page.locator('.rows tbody tr').nth(1).waitFor();
  const symbols = Object.fromEntries(await page.locator('.rows thead th.number').evaluateAll((all) =>
    all.map((each) => [each.querySelector('button').textContent.trim(), each.querySelector('small').textContent.trim()])));
  const expected = {
    'Thermal conductivity': 'W/(m K)', 'Slope of the density': 'kg/(m³ K)', 'Pressure-viscosity coefficient α*': '1/GPa', 'Vogel coefficient A₁': 'K',
    'Roughness σ': 'µm', 'Mesh loss': 'W', 'Hottest contact': '°C', 'Flash temperature rise maximum': 'K', 'Greatest pressure': 'GPa',
  };
  assert.deepEqual(Object.fromEntries(Object.keys(expected).map((label) => [label, symbols[label]])), expected);
  const texts = (unit) => page.locator(`.rows tbody [data-unit="${unit}"]`).allTextContents();
  assert.deepEqual(await texts('W/(m K)'), ['0.140', '0.154']);
  assert.deepEqual(await texts('kg/(m³ K)'), ['−0.650', '−0.600']);
  assert.deepEqual(await foreignNumbers(page), []);
});

test('candidates whose verdict a warning withholds have no rank, and refused ones stand with their reason', async () => {
  await server.call('POST', '/v1/lubricants?lubricant_id=stiff-oil', {
    display_name: 'Stiff oil', base_oil_class: 'BASE_OIL_CLASS_GROUP_I', pour_point_celsius: -10,
    measurements: {
      kinematic_viscosity_40_celsius_square_millimetres_per_second: 184, kinematic_viscosity_100_celsius_square_millimetres_per_second: 17,
      density_15_celsius_kilograms_per_cubic_metre: 900,
    },
  });
  const { name } = await server.call('POST', '/v1/campaigns', {
    candidate_lubricants: ['lubricants/paper-fluid-1', 'lubricants/paper-fluid-2', 'lubricants/stiff-oil'], model_options: { preset: 'PAPER' },
    conditions: [{ speed_kilometres_per_hour: 110, sump_temperature_celsius: -20 }],
  });
  while ((await server.call('GET', `/v1/${name}`)).state === 'RUNNING') await new Promise((done) => setTimeout(done, 50));
  await page.goto(`${server.address}/${name}`);
  await page.locator('.ranking tbody tr').nth(1).waitFor();
  assert.deepEqual(await page.locator('.ranking tbody tr td:first-child').allTextContents(), ['–', '–']);
  await page.locator('.validity[data-level="outside"] li', { hasText: 'INLET_HEATING_LEFT_OUT' }).first().waitFor();
  const refused = page.getByRole('region', { name: 'Refused candidates' });
  assert.match(await refused.textContent(), /Stiff oil.*BELOW_POUR_POINT/);
  assert.deepEqual(await foreignNumbers(page), []);
});

/** The campaign on whose page the browser is, with its candidates. */
const shownCampaign = () => server.call('GET', `/v1${new URL(page.url()).pathname}?view=CAMPAIGN_VIEW_FULL`);

test('the service makes the candidates of a design, whose mistakes stand at their fields', async () => {
  page.expect(400, 'campaigns?validate_only');
  await openForm();
  await page.getByRole('button', { name: 'A design' }).click();
  await page.getByLabel('Candidates', { exact: true }).fill('16');
  await page.getByLabel('Add a factor').selectOption('lubricant.relaxation_time_seconds');
  await page.getByLabel('Relaxation time, least').fill('0.2');
  await page.getByLabel('Relaxation time, greatest').fill('0.1');
  await page.getByLabel('Relaxation time, greatest').press('Tab');
  const factor = page.getByRole('group', { name: 'Factor 1' });
  await factor.locator('.problem', { hasText: 'the range is 2e-07 to 1e-07' }).waitFor();
  await page.getByLabel('Relaxation time, greatest').fill('0,6');
  await page.getByLabel('Relaxation time, greatest').press('Tab');
  await factor.getByLabel('Divided').selectOption('by ratios');
  await page.getByText('16 candidates at 12 conditions are 192 points').waitFor();
  await page.getByLabel('Add a factor').selectOption('surface.asperity_friction_coefficient');
  await page.getByRole('group', { name: 'Factor 2' }).locator('.problem', { hasText: 'states no standard uncertainty' }).waitFor();
  await page.getByLabel('friction coefficient, least').fill('0.05');
  await page.getByLabel('friction coefficient, greatest').fill('many');
  await page.getByLabel('friction coefficient, greatest').press('Tab');
  await page.getByText('"many" is not a number').waitFor();
  await page.getByLabel('friction coefficient, greatest').fill('0.12');
  await page.getByLabel('friction coefficient, greatest').press('Tab');
  await page.getByLabel('Method').selectOption('Grid');
  await page.getByLabel('Relaxation time, levels').fill('4');
  await page.getByLabel('Relaxation time, levels').press('Tab');
  await page.getByText('12 candidates at 12 conditions are 144 points').waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByLabel('Labels').fill('project=axle, a b=c');
  await page.getByLabel('Labels').press('Tab');
  await page.locator('.panel .problem', { hasText: 'allowed: letters, digits' }).waitFor();
  await page.getByLabel('Labels').fill('project=axle, series=b');
  await page.reload();
  await page.getByText('12 candidates at 12 conditions are 144 points').waitFor();
  await page.getByLabel('Labels').fill('project=axle, series=b');
  await page.getByLabel('Labels').press('Tab');
  await page.getByRole('button', { name: 'Create the campaign' }).click();
  await page.getByText('144 of 144 rows are computed').waitFor();
  const campaign = await shownCampaign();
  assert.deepEqual(campaign.candidate_design, {
    method: 'GRID', count: 0, seed: '0', algorithm_version: campaign.candidate_design.algorithm_version, factors: [
      { parameter: 'lubricant.relaxation_time_seconds', minimum: 2e-7, maximum: 6e-7, scale: 'LOGARITHMIC', levels: 4 },
      { parameter: 'surface.asperity_friction_coefficient', minimum: 0.05, maximum: 0.12, scale: 'SCALE_UNSPECIFIED', levels: 3 },
    ],
  });
  assert.deepEqual(campaign.labels, [{ key: 'project', value: 'axle' }, { key: 'series', value: 'b' }]);
  await page.getByRole('link', { name: 'series=b' }).click();
  await page.waitForURL(/\/campaigns\?label=series%3Db$/);
  await page.waitForFunction(() => document.querySelectorAll('tbody tr').length === 1);
});

test('fluids of the database are candidates, chosen or by a filter, and further ones are added', async () => {
  await server.newOil('first-oil', 'First oil', 103, 15.1, 868);
  await server.newOil('second-oil', 'Second oil', 95, 14.2, 862);
  await page.goto(`${server.address}/campaigns/new?from=filter`);
  page.expect(400, 'campaigns?validate_only');
  page.expect(400, 'filter=lims');
  await page.getByLabel('Filter', { exact: true }).fill('lims = 4');
  await page.getByLabel('Filter', { exact: true }).press('Tab');
  await page.locator('.problem', { hasText: '"lims" is not a field' }).waitFor();
  assert.equal(await page.locator('.notice').count(), 0);
  await page.getByLabel('Filter').fill('display_name : "Second oil"');
  await page.getByLabel('Filter').press('Tab');
  await page.getByRole('list', { name: 'Fluids that satisfy the filter' }).getByText('Second oil').waitFor();
  await page.getByText('1 candidates at 12 conditions').waitFor();
  await page.getByRole('button', { name: 'Fluids of the database' }).click();
  await page.getByText('Choose the fluids to be screened.').waitFor();
  await page.getByLabel('First oil').check();
  await page.getByLabel('Lubricant 1').check();
  await page.waitForURL(/of=first-oil,paper-fluid-1/);
  await page.getByText('2 candidates at 12 conditions are 24 points').waitFor();
  await page.getByRole('button', { name: 'Create the campaign' }).click();
  await page.getByText('24 of 24 rows are computed').waitFor();
  assert.deepEqual((await shownCampaign()).candidate_lubricants, ['lubricants/first-oil@1', 'lubricants/paper-fluid-1@1']);
  await page.getByRole('link', { name: 'Add candidates' }).click();
  await page.getByLabel('Second oil').check();
  assert.equal(await page.getByLabel('First oil').count(), 0);
  await page.getByText('Then 3 candidates at 12 conditions are 36 points').waitFor();
  await page.getByRole('button', { name: 'Add the candidates' }).click();
  await page.getByText('36 of 36 rows are computed').waitFor();
  await page.getByRole('button', { name: 'Second oil', exact: true }).waitFor();
});

test('a further table adds candidates to a campaign and leaves what is computed', async () => {
  page.expect(400, ':append');
  const { name } = await server.call('POST', '/v1/campaigns', campaignOf(4));
  await page.goto(`${server.address}/${name}`);
  await page.getByText('24 of 24 rows are computed').waitFor();
  const before = await server.call('GET', `/v1/${name}:read?alt=columns`);
  await page.getByRole('link', { name: 'Add candidates' }).click();
  const paste = (rows, header = 'alpha* [1/GPa];surface.asperity_friction_coefficient;additive;cost_euros_per_kilogram') =>
    page.getByLabel('Or paste it from a spreadsheet').fill(`${header}\n${rows}\n`);
  await paste('15;0,1;9;dear');
  await page.locator('td.wrong', { hasText: '"dear" is not a number; those of the campaign are' }).waitFor();
  await page.getByRole('button', { name: 'Take the table away' }).click();
  await paste('15', 'alpha* [1/GPa]');
  await page.locator('.notice', { hasText: 'lacks the column "surface.asperity_friction_coefficient"' }).waitFor();
  assert.ok(await page.getByRole('button', { name: 'Add the candidates' }).isDisabled());
  await page.getByRole('button', { name: 'Take the table away' }).click();
  await paste('15;0,1;9;7,5\n16;50;9;8');
  await page.locator('td.wrong', { hasText: 'allowed: 0 to 2' }).waitFor();
  await page.getByRole('button', { name: 'Take the table away' }).click();
  await paste('15;0,1;9;7,5\n16;0,11;9;8');
  await page.getByText('Then 6 candidates at 6 conditions are 36 points').waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByRole('button', { name: 'Add the candidates' }).click();
  await page.getByText('36 of 36 rows are computed').waitFor();
  const campaign = await shownCampaign();
  assert.deepEqual(campaign.candidate_columns.map(({ values }) => values.slice(4)), [[1.5e-8, 1.6e-8], [0.1, 0.11]]);
  assert.deepEqual(campaign.candidate_attributes.map(({ texts, values }) => [texts.slice(4), values.slice(4)]), [[['9', '9'], []], [[], [7.5, 8]]]);
  const after = await server.call('GET', `/v1/${name}:read?alt=columns`);
  assert.deepEqual(after.columns.mesh_loss_power_watts.slice(0, 24), before.columns.mesh_loss_power_watts);
});

test('a campaign of a rig is ranked by traction and shows its conditions', async () => {
  const rig = { radius_x_metres: 0.0127, grid: { supply_temperatures_celsius: [40], loads_newtons: [35], entrainment_speeds_metres_per_second: [2], slide_roll_ratios_percent: [5, 50] } };
  const { name } = await server.call('POST', '/v1/campaigns', campaignOf(12, { display_name: 'on a rig', conditions: undefined, surface: 'surfaces/run-in', rig }));
  while ((await server.call('GET', `/v1/${name}`)).state === 'RUNNING') await new Promise((done) => setTimeout(done, 50));
  await page.goto(`${server.address}/campaigns`);
  await page.getByText('of a rig').waitFor();
  await page.goto(`${server.address}/${name}`);
  await page.getByText('at 2 conditions; rig, run-in').waitFor();
  await page.locator('.ranking tbody tr').nth(11).waitFor();
  assert.match(await page.locator('.ranking thead').textContent(), /Traction coefficient/);
  assert.deepEqual(await foreignNumbers(page), []);
  await page.goto(`${server.address}/${name}?view=pareto`);
  await page.getByText('are beaten', { exact: false }).first().waitFor();
  await page.goto(`${server.address}/${name}?view=rows&at=1`);
  const condition = page.getByLabel('Condition');
  await condition.waitFor();
  const texts = await condition.locator('option').allTextContents();
  assert.equal(texts.length, 3);
  assert.match(texts[1], /^35(\.0+)? N, 2(\.0+)? m\/s, 50(\.0+)? %, 40(\.0+)? °C$/);
  const header = await page.locator('.rows thead').textContent();
  for (const each of ['Traction coefficient', 'Central film thickness', 'Film ratio', 'Contact temperature']) assert.ok(header.includes(each), each);
  assert.deepEqual(await foreignNumbers(page), []);
});
