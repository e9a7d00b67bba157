// What a formulator decides by: which fluid loses less, how sure that is, and why.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { foreignNumbers, launch, newPage, output, Server, signIn, TRIBODYN } from './harness.mjs';

let browser;
let server;
let page;
before(async () => {
  browser = await launch();
  server = await new Server().start();
  await server.newOil('my-oil', 'My oil', 103, 15.1, 868);
  await server.newOil('their-oil', 'Their oil', 95, 14.1, 862);
  await newMeasuredOil('low-oil', 'Low oil', 1.4e-8);
  await newMeasuredOil('high-oil', 'High oil', 2.6e-8);
  await newCertainOil('certain-1', 'Certain 1', 'paper-fluid-1');
  await newCertainOil('certain-2', 'Certain 2', 'paper-fluid-2');
  page = await newPage(browser, server);
  await page.goto(server.address);
  await signIn(page, server.token);
});
after(async () => {
  await browser?.close();
  await server?.remove();
});

/** An oil whose pressure-viscosity coefficient is known well, which decides most. */
async function newMeasuredOil(id, name, coefficient) {
  await server.newOil(id, name, 103, 15.1, 868);
  const field = 'pressure_viscosity_coefficient_per_pascal';
  const { provenance } = await server.call('GET', `/v1/lubricants/${id}`);
  await server.call('PATCH', `/v1/lubricants/${id}?update_mask=${field},provenance`, {
    [field]: coefficient,
    provenance: [...provenance.filter((each) => each.field !== field), { field, provenance: 'PROVENANCE_MEASURED', standard_uncertainty: 0.01 * coefficient }],
  });
}

/** A copy of a fluid whose numbers have no stated uncertainty. */
async function newCertainOil(id, display_name, like) {
  const { provenance, ...numbers } = await server.call('GET', `/v1/lubricants/${like}`);
  const oil = { display_name };
  for (const [field, value] of Object.entries(numbers)) if (typeof value === 'number') oil[field] = value;
  await server.call('POST', `/v1/lubricants?lubricant_id=${id}`, oil);
}

/** The exact values of a row of bars, by the words of its label. */
const valuesOf = (region) =>
  page.getByRole('table', { name: region }).locator('tbody tr').evaluateAll((rows) =>
    Object.fromEntries(rows.map((row) => [row.querySelector('th').textContent, Number(row.querySelector('[data-value]')?.dataset.value)])));

test('two fluids that their inputs do not tell apart are said to be so, with interval and probability', async () => {
  await page.goto(`${server.address}/fluids`);
  await page.getByLabel('Choose My oil').check();
  await page.getByLabel('Choose Their oil').check();
  await page.getByRole('link', { name: 'Compare the two' }).click();
  await page.getByRole('heading', { name: 'My oil and Their oil cannot be told apart' }).waitFor();
  await page.getByText(/Probability that Their oil loses less: [3-7]\d %/).first().waitFor();
  await page.getByText('Every speed').click();
  const verdicts = await page.getByRole('region', { name: 'Every speed' }).locator('tbody tr td:last-child').allTextContents();
  assert.deepEqual(verdicts, Array(13).fill('cannot be told apart'));
  await page.getByRole('heading', { name: /Measure first: Pressure-viscosity coefficient/ }).waitFor();
  const answer = await server.call('POST', '/v1/points:compare', {
    lubricants: ['lubricants/my-oil', 'lubricants/their-oil'], conditions: Array.from({ length: 13 }, (_, k) => ({ speed_kilometres_per_hour: 20 + 10 * k, sump_temperature_celsius: 40 })),
  });
  const decide = answer.lubricants[1].differences[4].deciding_inputs; // at 60 km/h
  assert.equal(await page.locator('.deciding > span').count(), decide.length);
  await page.getByText(answer.not_included).waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
});

test('fluids whose difference is certain are ordered', async () => {
  await page.goto(`${server.address}/compare?a=low-oil&b=high-oil`);
  await page.getByRole('heading', { name: 'High oil loses more than Low oil' }).waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByRole('button', { name: 'Exchange A and B' }).click();
  await page.getByRole('heading', { name: 'Low oil loses less than High oil' }).waitFor();
  assert.match(new URL(page.url()).search, /a=high-oil&b=low-oil/);
});

test('fluids without a stated uncertainty have a difference and no verdict, and inputs that count as exact are named', async () => {
  await page.goto(`${server.address}/compare?a=certain-1&b=certain-2`);
  await page.getByRole('heading', { name: /Certain 1 and Certain 2: no verdict/ }).waitFor();
  await page.getByText('No input of the two has a stated uncertainty').click();
  await page.getByText(/Certain 2: Vogel prefactor/).waitFor();
  assert.equal(await page.getByText('Probability that').count(), 0);
  await page.getByText('Every speed', { exact: true }).click();
  assert.equal(await page.getByRole('region', { name: 'Every speed' }).locator('tbody .interval', { hasText: 'not stated' }).count(), 26);
  assert.deepEqual(await foreignNumbers(page), []);
});

test('a warning withholds the verdict of a comparison, and says for which fluids and speeds', async () => {
  await page.goto(`${server.address}/compare?a=low-oil&b=high-oil&sump=0&model=paper`);
  await page.getByRole('heading', { name: /Low oil and High oil: no verdict/ }).waitFor();
  assert.equal(await page.getByText('Probability that').count(), 0);
  const remark = page.locator('.validity[data-level="outside"] li', { hasText: 'INLET_HEATING_LEFT_OUT' }).first();
  assert.match(await remark.textContent(), /Low oil.*; High oil/);
  await page.locator('.panel label', { hasText: /^Model/ }).locator('select').selectOption('recommended');
  await page.getByRole('heading', { name: /loses (less|more) than|cannot be told apart/ }).waitFor();
});

test('the bars of an explanation are the shares of the service, which sum to the difference', async () => {
  await page.goto(`${server.address}/compare?a=paper-fluid-1&b=paper-fluid-2&at=mean&model=paper`);
  await page.getByRole('table', { name: 'What each property group adds' }).waitFor();
  const inefficiency = await valuesOf('What each property group adds');
  const { 'Together: Lubricant 2 less Lubricant 1': sum, ...shares } = inefficiency;
  assert.ok(Math.abs(Object.values(shares).reduce((a, b) => a + b) - sum) < 1e-9, JSON.stringify(inefficiency));
  assert.ok(shares['Rise of viscosity with pressure'] > 0.2 && shares['Viscosity and its temperature law'] < 0);
  await page.getByText('Before or after the others').click();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByRole('button', { name: 'Loss, W' }).click();
  assert.ok((await valuesOf('What each property group adds'))['Rise of viscosity with pressure'] > 5);
  assert.deepEqual(await foreignNumbers(page), []);
});

test('a click on a speed explains the difference there, and its commands and table repeat it', async () => {
  await page.goto(`${server.address}/compare?a=my-oil&b=paper-fluid-3&sump=90&from=40&to=80&step=20&dsump=2`);
  await page.locator('.bars').first().waitFor();
  const plot = await page.locator('.u-over').first().boundingBox();
  await page.mouse.click(plot.x + plot.width - 4, plot.y + 40);
  await page.waitForURL(/at=80/);
  await page.waitForFunction(() => document.querySelector('.reasons select')?.value === '80' && !document.querySelector('.stale'));
  const sum = (await valuesOf('What each property group adds'))['Together: Lubricant 3 less My oil'];
  await page.getByText('Take away').click();
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Numbers as CSV' }).click()]);
  const [, ...rows] = readFileSync(await download.path(), 'utf8').trim().split('\n').map((line) => line.split(','));
  assert.deepEqual(rows.map((row) => row[0]), ['40', '60', '80']);
  const commands = (await page.getByLabel('Command line').textContent()).split('\n');
  const run = async (command) => JSON.parse(await output(TRIBODYN, ['--server', `unix:${server.folder}/socket`, ...command.split(' ').slice(1), '-o', 'json']));
  const compared = await run(commands[0]);
  assert.equal(compared.lubricants[1].differences[2].difference_percent.value, Number(rows[2][11]));
  assert.equal((await run(commands[1])).points[0].inefficiency_difference_percent.value, sum);
});

test('a comparison has its speeds in rpm of the pinion and the torque there if the reader wants so', async () => {
  await page.goto(`${server.address}/compare?a=my-oil&b=paper-fluid-3&from=40&to=80&step=20&at=60`);
  await page.locator('.bars').first().waitFor();
  await page.getByText('Units', { exact: true }).click();
  await page.getByLabel('Unit: Speed of curves').selectOption('rpm');
  await page.getByText('Units', { exact: true }).click();
  const answer = await server.call('POST', '/v1/points:compare', {
    lubricants: ['lubricants/my-oil', 'lubricants/paper-fluid-3'], conditions: [40, 60, 80].map((speed_kilometres_per_hour) => ({ speed_kilometres_per_hour })),
  });
  const rpm = answer.mean_pinion_speed_radians_per_second.map((each) => ((30 / Math.PI) * each).toFixed(0));
  await page.getByText('Mean speed of the pinion, rpm').waitFor();
  assert.deepEqual(await page.locator('.reasons select option').allTextContents(), [...rpm.map((each) => `${each} rpm`), 'the mean of all speeds']);
  const torque = answer.lubricants[0].points[1].pinion_torque_newton_metres.value;
  const shown = Number(await page.locator('.reasons [data-unit="N m"]').first().textContent());
  assert.ok(Math.abs(shown - torque) < 0.01 * torque, `${shown} N m, the service: ${torque}`);
  const plot = await page.locator('.u-over').first().boundingBox();
  await page.mouse.click(plot.x + plot.width - 4, plot.y + 40);
  await page.waitForURL(/at=80/);
  await page.getByText('Every speed', { exact: true }).click();
  assert.deepEqual(await page.getByRole('region', { name: 'Every speed' }).locator('tbody tr td:first-child').allTextContents(), rpm);
  assert.deepEqual(await foreignNumbers(page), []);
  await page.evaluate(() => localStorage.removeItem('units'));
  await page.reload();
  await page.getByText('Vehicle speed, km/h').waitFor();
});

test('a stranger enters an oil, compares, explains, finds the worst speed and hands over a link, by what the pages say', async () => {
  await page.goto(server.address);
  await page.getByRole('link', { name: 'Enter an oil' }).click();
  await page.getByLabel('Name').fill('Trial oil 75W-90');
  await page.getByLabel('Viscosity at 40 °C').fill('110');
  await page.getByLabel('Viscosity at 100 °C').fill('15.6');
  await page.getByLabel('Density at 15 °C').fill('870');
  await page.getByRole('button', { name: 'Save' }).click();
  await page.waitForURL(/\/fluids\/trial-oil-75w-90$/);
  await page.locator('main').getByRole('link', { name: 'Compare' }).click();
  await page.getByRole('heading', { name: /Trial oil 75W-90.*Lubricant 1|Lubricant 1.*Trial oil 75W-90/ }).waitFor();
  await page.getByRole('table', { name: 'What each property group adds' }).waitFor();
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.getByText('Take away').click();
  await page.getByRole('button', { name: 'Copy a link to this page' }).click();
  const link = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(link, /a=paper-fluid-1@1&b=trial-oil-75w-90@1/);
  const headline = await page.getByRole('heading', { level: 1 }).textContent();
  await server.call('PATCH', '/v1/lubricants/trial-oil-75w-90?update_mask=pressure_viscosity_coefficient_per_pascal', { pressure_viscosity_coefficient_per_pascal: 3e-8 });
  await page.goto(link);
  await page.getByRole('table', { name: 'What each property group adds' }).waitFor();
  assert.equal(await page.getByRole('heading', { level: 1 }).textContent(), headline, 'the link shows the same after an edit');
  await page.goto(`${server.address}/fluids/trial-oil-75w-90`);
  await page.getByRole('link', { name: 'Run a curve' }).click();
  await page.getByRole('button', { name: 'Run the curve' }).click();
  await page.locator('.read-out').waitFor();
  await page.getByRole('button', { name: 'To the greatest inefficiency' }).click();
  const { columns } = await server.call('GET', `/v1/simulations/${new URL(page.url()).searchParams.get('r')}?alt=columns&columns=speed_kilometres_per_hour,inefficiency_energy_mean_percent`);
  const worst = columns.inefficiency_energy_mean_percent.indexOf(Math.max(...columns.inefficiency_energy_mean_percent.filter((each) => each !== null)));
  await page.getByRole('heading', { name: `At ${columns.speed_kilometres_per_hour[worst]} km/h` }).waitFor();
});

test('a refused comparison names the field', async () => {
  page.expect(400, 'points:compare');
  page.expect(400, 'points:explain');
  await page.goto(`${server.address}/compare?a=my-oil&b=their-oil&sump=400`);
  await page.locator('.panel .problem', { hasText: 'allowed: -70 to 200' }).waitFor();
  assert.equal(await page.getByLabel('Sump, °C').getAttribute('aria-invalid'), 'true');
});

/** Curves of fluids on the page, completely read. */
async function showCurves(fluids, settings = '') {
  const jobs = [];
  for (const fluid of fluids) {
    jobs.push(await server.call('POST', '/v1/simulations', {
      lubricant: `lubricants/${fluid}`,
      inefficiency_curve: { first_speed_kilometres_per_hour: 60, last_speed_kilometres_per_hour: 90, speed_step_kilometres_per_hour: 5 },
    }));
  }
  await page.goto(`${server.address}/curves?r=${jobs.map((job) => job.name.split('/')[1]).join(',')}${settings}`);
  await page.locator('.read-out').waitFor();
}

test('curves have the intervals of their inputs and their difference from a reference', async () => {
  await showCurves(['my-oil', 'their-oil']);
  await page.getByRole('link', { name: 'Their oil cannot be told apart' }).waitFor();
  await page.getByText('holds the curve with 95').waitFor();
  assert.match(await page.locator('.read-out tbody tr').nth(1).textContent(), /\d to \d/);
  assert.deepEqual(await foreignNumbers(page), []);
  await page.locator('.differences select').selectOption('their-oil');
  await page.getByRole('link', { name: 'My oil cannot be told apart' }).waitFor();
  await page.getByLabel('Uncertainty of the inputs').uncheck();
  await page.getByText('holds the curve with 95').waitFor({ state: 'detached' });
  assert.doesNotMatch(await page.locator('.read-out tbody tr').nth(1).textContent(), /\d to \d/);
  assert.match(new URL(page.url()).search, /ref=their-oil&u=0/);
});

test('one click computes the curve of another model beside the full one', async () => {
  await showCurves(['paper-fluid-1']);
  await page.getByText('the branch of steady states ends').waitFor();
  await page.getByRole('button', { name: 'Isothermal', exact: true }).click();
  await page.getByText('what the model option changes').waitFor();
  assert.deepEqual(await page.locator('.read-out tbody th').allTextContents(), ['Lubricant 1, full model', 'Lubricant 1, isothermal']);
  assert.ok(await page.getByRole('button', { name: 'Isothermal', exact: true }).isDisabled());
  assert.deepEqual(await foreignNumbers(page), []);
});

test('the loss of each curve is split, and a zoom stands in the address', async () => {
  await showCurves(['paper-fluid-1', 'paper-fluid-2'], '&y=split');
  await page.getByText('boundary friction', { exact: true }).waitFor();
  await page.locator('.histories canvas').nth(1).waitFor();
  assert.equal(await page.locator('.histories canvas').count(), 2);
  const plot = await page.locator('.histories .u-over').first().boundingBox();
  await page.mouse.move(plot.x + 0.4 * plot.width, plot.y + 50);
  await page.mouse.down();
  await page.mouse.move(plot.x + 0.8 * plot.width, plot.y + 50, { steps: 4 });
  await page.mouse.up();
  await page.waitForURL(/x=7\d(\.\d+)?-8\d/);
  await page.reload();
  await page.getByRole('button', { name: 'Show all speeds' }).click();
  await page.waitForURL((url) => !url.search.includes('x='));
});

/** The main plot as text, and the first and the last row of pixels of a line relative to its height. */
const pictureOf = () => page.locator('.figure canvas').first().evaluate((canvas) => {
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const rows = [];
  for (let i = 0; i < data.length; i += 4) {
    const colors = [data[i], data[i + 1], data[i + 2]];
    if (data[i + 3] > 200 && Math.max(...colors) - Math.min(...colors) > 60) rows.push(Math.floor(i / 4 / canvas.width) / canvas.height);
  }
  return { text: canvas.toDataURL(), first: rows[0], last: rows.at(-1) };
});

const painted = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

test('a plot is moved with Shift without a new table, and shows in the end what its address shows', async () => {
  await showCurves(['paper-fluid-1', 'paper-fluid-2'], '&x=60-75&u=0');
  await page.waitForFunction(() => document.querySelectorAll('.read-out tbody tr').length === 2);
  await painted();
  const before = await pictureOf();
  assert.ok(before.last - before.first > 0.5, 'the lines that are shown fill the height');
  await page.evaluate(() => {
    window.tableChanges = 0;
    new MutationObserver((changes) => (window.tableChanges += changes.length)).observe(document.querySelector('.read-out'), { subtree: true, childList: true, characterData: true });
  });
  const plot = await page.locator('.figure .u-over').first().boundingBox();
  for (const [share, speed] of [[0.3, 65], [0.7, 70]]) {
    await page.mouse.move(plot.x + share * plot.width, plot.y + 50);
    await page.getByRole('heading', { name: `At ${speed} km/h` }).waitFor();
  }
  await page.keyboard.down('Shift');
  await page.mouse.move(plot.x + 0.8 * plot.width, plot.y + 50);
  await page.evaluate(() => (window.tableChanges = 0));
  await page.mouse.down();
  await page.mouse.move(plot.x + 0.4 * plot.width, plot.y + 50, { steps: 8 });
  await painted();
  const during = await pictureOf();
  assert.notEqual(during.text, before.text);
  assert.ok(during.last - during.first > 0.3, 'the lines are drawn while they move');
  assert.match(page.url(), /x=60-75/);
  assert.equal(await page.evaluate(() => window.tableChanges), 0);
  await page.mouse.up();
  await page.keyboard.up('Shift');
  await page.waitForURL(/x=66(\.\d+)?-81/);
  await page.mouse.move(5, 5);
  await painted();
  const after = await pictureOf();
  await page.reload();
  await page.waitForFunction(() => document.querySelectorAll('.read-out tbody tr').length === 2);
  await painted();
  assert.equal((await pictureOf()).text, after.text);
});

test('a curve leads to everything that it rests on, with its origin', async () => {
  await showCurves(['my-oil']);
  await page.locator('.validity summary').click();
  await page.getByRole('link', { name: 'assumptions of my-oil@1' }).click();
  const rows = page.getByRole('region', { name: 'Assumptions' }).locator('tbody tr');
  await rows.first().waitFor();
  const { result } = await server.call('GET', `/v1/simulations/${page.url().split('/').pop()}`);
  assert.equal(await rows.count(), result.assumptions.length);
  const coefficient = rows.filter({ hasText: 'pressure viscosity coefficient' });
  assert.match(await coefficient.textContent(), /assumed|literature|derived|fitted/);
});

test('single keys lead to views, to a search, to a run and to the table of every speed, and can be switched off', async () => {
  const { keyboard } = page;
  await page.goto(`${server.address}/more`);
  await page.locator('.places').waitFor();
  await keyboard.press('g');
  await keyboard.press('f');
  await page.waitForURL(/\/fluids$/);
  await page.goto(`${server.address}/more`);
  await page.locator('.places').waitFor();
  await keyboard.press('/');
  await page.waitForFunction(() => document.activeElement?.matches('.search input'));
  await keyboard.type('gc/');
  assert.equal(await page.getByLabel('Search names').inputValue(), 'gc/');
  await page.goto(`${server.address}/curves?f=paper-fluid-1&from=40&to=60&step=10`);
  await page.getByRole('button', { name: 'Run the curve' }).waitFor();
  await keyboard.press('r');
  await page.locator('.read-out').waitFor();
  await keyboard.press('t');
  const table = page.getByRole('region', { name: 'Every speed' }).locator('tbody tr');
  await table.nth(2).waitFor();
  const shown = await table.locator('[data-value]').evaluateAll((all) => all.map((each) => Number(each.dataset.value)));
  const { columns } = await server.call('GET', `/v1/simulations/${new URL(page.url()).searchParams.get('r')}?alt=columns`);
  assert.deepEqual(shown, columns.inefficiency_energy_mean_percent);
  await keyboard.press('?');
  await page.getByLabel('Single keys do this').uncheck();
  await page.getByRole('button', { name: 'Leave' }).click();
  await keyboard.press('t');
  await table.nth(2).waitFor();
  await keyboard.press('?');
  await page.getByLabel('Single keys do this').check();
  await keyboard.press('Escape');
  await page.getByRole('dialog').waitFor({ state: 'detached' });
  assert.deepEqual(await foreignNumbers(page), []);
});
