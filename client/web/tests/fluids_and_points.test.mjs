// Fluids, jobs and points: what is entered, what is refused, what is followed.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { foreignNumbers, launch, newPage, Server, signIn } from './harness.mjs';

let browser;
let server;
let page;
before(async () => {
  browser = await launch();
  server = await new Server('--projects', 'axles').start();
  page = await newPage(browser, server);
  await page.goto(server.address);
  await signIn(page, server.token);
});
after(async () => {
  await browser?.close();
  await server?.remove();
});

test('an oil is entered from its data sheet by the keyboard alone', async () => {
  await page.goto(`${server.address}/fluids`);
  await page.getByRole('link', { name: 'Enter an oil' }).press('Enter');
  await page.getByLabel('Name').focus();
  const { keyboard } = page;
  // The id follows from the name.
  for (const word of ['My oil', '', '', '103', '15.1', '868']) {
    if (word !== '') await keyboard.type(word);
    await keyboard.press('Tab');
  }
  await keyboard.press('Enter');
  await page.waitForURL(/\/fluids\/my-oil$/);
  await page.getByText('KV100').waitFor();
  const oil = await server.call('GET', '/v1/lubricants/my-oil');
  assert.equal(oil.measurements.kinematic_viscosity_40_celsius_square_millimetres_per_second, 103);
  assert.equal(oil.base_oil_class, 'BASE_OIL_CLASS_POLYALPHAOLEFIN');
});

test('a mistake is named at its field, with the unit and range of the schema', async () => {
  page.expect(400, 'lubricants/my-oil');
  await page.goto(`${server.address}/fluids/my-oil/edit`);
  const field = page.getByLabel(/Pressure-viscosity coefficient/);
  await page.getByText('Parameters of the model').click();
  await page.getByText('0.1 to 1000').waitFor();
  const before = await server.call('GET', '/v1/lubricants/my-oil');
  assert.equal(Number(await field.inputValue()).toPrecision(6), (1e9 * before.pressure_viscosity_coefficient_per_pascal).toPrecision(6));
  await field.fill('20000');
  await page.getByRole('button', { name: /Save/ }).click();
  await page.locator('.problem', { hasText: '2e-05 1/Pa' }).waitFor();
  assert.equal(await field.getAttribute('aria-invalid'), 'true');
  assert.ok(await field.evaluate((element) => element === document.activeElement), 'the field has the focus');
  await field.fill('abc');
  await page.getByRole('button', { name: /Save/ }).click();
  await page.locator('.problem', { hasText: '"abc" is not a number' }).waitFor();
  await field.fill('20');
  await page.getByRole('button', { name: /Save/ }).click();
  await page.waitForURL(/\/fluids\/my-oil$/);
  const saved = await server.call('GET', '/v1/lubricants/my-oil');
  assert.equal(saved.pressure_viscosity_coefficient_per_pascal, 2e-8);
  assert.equal(saved.revision, before.revision + 1);
  assert.equal(saved.measurements.kinematic_viscosity_40_celsius_square_millimetres_per_second, 103, 'other fields stay');
});

test('a fluid whose viscosity was measured under pressure is entered with the law of that', async () => {
  page.expect(400, 'lubricants?');
  await page.goto(`${server.address}/fluids/new`);
  await page.getByLabel('Name').fill('Measured oil');
  for (const [label, value] of [['Viscosity at 40 °C', '103'], ['Viscosity at 100 °C', '15.1'], ['Density at 15 °C', '868']]) await page.getByLabel(label).fill(value);
  await page.getByText('Parameters of the model').click();
  for (const [label, value] of [[/at the glass transition/, '1e12'], ['Yasutomi A₁', '50'], ['Yasutomi A₂', '1.5'], ['Yasutomi b₁', '7']]) await page.getByLabel(label).fill(value);
  await page.getByRole('button', { name: 'Save' }).click();
  await page.locator('.problem', { hasText: 'expansivity_exponent' }).waitFor();
  await page.getByLabel('Yasutomi b₂').fill('-0.5');
  await page.getByRole('button', { name: 'Save' }).click();
  await page.waitForURL(/\/fluids\/measured-oil$/);
  await page.getByRole('rowheader', { name: 'Yasutomi b₂' }).waitFor();
  const { improved_yasutomi: law } = await server.call('GET', '/v1/lubricants/measured-oil');
  assert.equal(law.glass_pressure_factor_per_pascal, 1.5e-9);
  assert.equal(law.expansivity_exponent, -0.5);
});

test('an oil has the boundary friction that its additives bring', async () => {
  await page.goto(`${server.address}/fluids/measured-oil/edit`);
  await page.getByLabel(/Boundary friction coefficient/).fill('0.09');
  await page.getByLabel(/Shear strength of the tribofilm/).fill('3');
  await page.getByRole('button', { name: /Save/ }).click();
  await page.waitForURL(/\/fluids\/measured-oil$/);
  const saved = await server.call('GET', '/v1/lubricants/measured-oil');
  assert.equal(saved.asperity_friction_coefficient, 0.09);
  assert.equal(saved.tribofilm_shear_strength_pascals, 3e6);
});

test('a dropped table shows what is wrong at its row', async () => {
  page.expect(400, 'lubricants:import');
  await page.goto(`${server.address}/fluids/new`);
  await page.getByLabel('Id').fill('dropped');
  const drop = async (text) => {
    const data = await page.evaluateHandle((csv) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([csv], 'oil.csv', { type: 'text/csv' }));
      return transfer;
    }, text);
    await page.locator('.drop').dispatchEvent('drop', { dataTransfer: data });
    await page.getByText('oil.csv').waitFor();
  };
  await drop('T (C),KV (mm2/s)\n40,103\n70,abc\n100,15.1\n');
  await page.getByRole('button', { name: 'Save' }).click();
  await page.locator('.table-preview li').nth(2).getByText(/"abc"; allowed: a finite number/).waitFor();
  assert.equal(await page.locator('.table-preview .wrong').count(), 1);
  await drop('T (C),KV (mm2/s)\n40,103\n70,34.5\n100,15.1\n');
  await page.getByRole('button', { name: 'Save' }).click();
  await page.waitForURL(/\/fluids\/dropped$/);
  assert.equal((await server.call('GET', '/v1/lubricants/dropped')).measurements.viscosities.length, 3);
});

test('a running job is followed and cancelled in the list', async () => {
  await page.goto(`${server.address}/jobs`);
  await page.getByText('No job is in this list').waitFor();
  const job = await server.call('POST', '/v1/simulations', {
    lubricant: 'lubricants/my-oil',
    solver_options: { method: 'STEADY_STATE_METHOD_MARCH' },
    inefficiency_curve: { first_speed_kilometres_per_hour: 20, last_speed_kilometres_per_hour: 120, speed_step_kilometres_per_hour: 1 },
  });
  await page.locator('.state.running').waitFor();
  await page.getByRole('button', { name: 'Cancel job 1' }).click();
  await page.locator('.state.cancelled').waitFor();
  assert.equal((await server.call('GET', `/v1/${job.name}`)).state, 'CANCELLED');
});

test('jobs are listed by label', async () => {
  const of = (label) => server.call('POST', '/v1/simulations', {
    lubricant: 'lubricants/my-oil', labels: label ? [label] : [],
    operating_point: { cruise: { speed_kilometres_per_hour: 50 } },
  });
  await of();
  const job = await of({ key: 'series', value: 'winter' });
  await page.goto(`${server.address}/jobs`);
  await page.getByRole('link', { name: 'series=winter' }).click();
  await page.waitForURL(/label=series(=|%3D)winter$/);
  await page.getByText('Those with the label series=winter').waitFor();
  await page.waitForFunction(() => document.querySelectorAll('table.jobs tbody tr').length === 1);
  assert.equal(await page.locator('table.jobs tbody tr td').first().textContent(), job.name.split('/')[1]);
  const later = await of({ key: 'series', value: 'winter' });
  await page.getByRole('link', { name: later.name.split('/')[1], exact: true }).waitFor();
  await page.getByRole('button', { name: 'Show all jobs' }).click();
  await page.waitForFunction(() => document.querySelectorAll('table.jobs tbody tr').length > 2);
});

test('a failed job says why', async () => {
  const job = await server.call('POST', '/v1/simulations', {
    lubricant: 'lubricants/my-oil', deadline_seconds: 0.01,
    solver_options: { method: 'STEADY_STATE_METHOD_MARCH' },
    inefficiency_curve: { first_speed_kilometres_per_hour: 20, last_speed_kilometres_per_hour: 120, speed_step_kilometres_per_hour: 1 },
  });
  await page.goto(`${server.address}/jobs/${job.name.split('/')[1]}`);
  await page.locator('.notice.error', { hasText: 'DEADLINE_EXCEEDED' }).waitFor();
});

test('a speed of a curve opens its histories, and a zoom fetches their rows', async () => {
  const curve = await server.call('POST', '/v1/simulations', {
    lubricant: 'lubricants/paper-fluid-1',
    inefficiency_curve: { first_speed_kilometres_per_hour: 60, last_speed_kilometres_per_hour: 90, speed_step_kilometres_per_hour: 5 },
  });
  await page.goto(`${server.address}/curves?r=${curve.name.split('/')[1]}`);
  await page.getByRole('heading', { name: 'At 75 km/h' }).waitFor();
  await page.getByRole('button', { name: 'Open the point' }).click();
  await page.waitForURL(/\/point\/\d+$/);
  await page.getByText('the flanks separate').waitFor();
  const histories = page.locator('.histories');
  await histories.locator('canvas').first().waitFor();
  assert.ok(Number(await histories.getAttribute('data-rows-per-pair')) > 0, 'all rows are an envelope');
  const box = await page.locator('.u-over').first().boundingBox();
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 50);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.35 * box.width, box.y + 50, { steps: 4 });
  const [request] = await Promise.all([page.waitForRequest(/readHistory/), page.mouse.up()]);
  const query = new URL(request.url()).searchParams;
  assert.ok(Number(query.get('start_row')) > 300 && Number(query.get('row_count')) < 500, request.url());
  await page.locator('.histories[data-rows-per-pair="0"]').waitFor();
  assert.match(new URL(page.url()).search, /t=0\.\d+-0\.\d+/);
  await page.reload();
  await page.locator('.histories[data-rows-per-pair="0"]').waitFor();
  await page.getByRole('button', { name: 'Show both cycles' }).click();
  await page.waitForFunction(() => Number(document.querySelector('.histories')?.dataset.rowsPerPair) > 0);
});

test('a point has its phase portrait, its order spectrum and what moves it', async () => {
  const curve = await server.call('POST', '/v1/simulations', {
    lubricant: 'lubricants/paper-fluid-1',
    inefficiency_curve: { first_speed_kilometres_per_hour: 50, last_speed_kilometres_per_hour: 60, speed_step_kilometres_per_hour: 5 },
  });
  await page.goto(`${server.address}/curves?r=${curve.name.split('/')[1]}`);
  await page.getByRole('button', { name: 'Open the point' }).click();
  await page.getByText('Phase portrait').waitFor();
  const bars = page.getByRole('table', { name: 'Sensitivities of Mesh inefficiency', exact: true });
  await bars.waitFor();
  await page.getByText('The largest amplitudes').click();
  assert.deepEqual(await foreignNumbers(page), []);
  const name = `simulations/${page.url().split('/').pop().split('?')[0]}`;
  const { result } = await server.call('GET', `/v1/${name}?read_mask=result.points.result.sensitivities`);
  const given = result.points[0].result.sensitivities;
  const figure = given.figures.indexOf('inefficiency_energy_mean_percent');
  const largest = Math.max(...given.parameters.map((each) => Math.abs(each.elasticities[figure])));
  assert.equal(Math.abs(Number(await bars.locator('[data-value]').first().getAttribute('data-value'))), largest);
  await page.getByLabel('Figure whose sensitivities').selectOption({ label: 'Film ratio, mean' });
  await page.getByRole('table', { name: 'Sensitivities of Film ratio, mean' }).waitFor();
  await page.getByLabel('History whose spectrum').selectOption({ label: 'Mesh force' });
  await page.waitForURL(/s=film_ratio.mean&o=mesh_force_newtons/);
  const spectrum = await server.call('GET', `/v1/${name}:readSpectrum?columns=mesh_force_newtons`);
  await page.waitForFunction((force) => document.querySelector('.pair table [data-value]')?.dataset.value === String(force), Math.max(...spectrum.columns[0].amplitudes));
});

test('a point that kept little is computed again with everything that its page shows', async () => {
  const { name } = await server.call('POST', '/v1/simulations', { lubricant: 'lubricants/paper-fluid-1', operating_point: { cruise: { speed_kilometres_per_hour: 55 } } });
  await page.goto(`${server.address}/point/${name.split('/')[1]}`);
  await page.getByRole('button', { name: 'Compute the point with histories and sensitivities' }).click();
  await page.getByText('Phase portrait').waitFor();
});

test('the viscosity of a fluid stands over temperature and pressure, beside another one, in either unit', async () => {
  await page.goto(`${server.address}/fluids/my-oil`);
  await page.getByRole('button', { name: 'Viscosity' }).click();
  await page.getByLabel('Beside').selectOption('paper-fluid-1');
  await page.getByText('Kinematic viscosity at ambient pressure').waitFor();
  await page.getByText('Every number at ambient pressure').click();
  await page.locator('thead th', { hasText: 'Lubricant 1' }).waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByText('Units', { exact: true }).click();
  await page.getByLabel('Unit: Viscosity').selectOption('mPa s');
  await page.getByText('Dynamic viscosity at ambient pressure, mPa s; hollow: measured').waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByLabel('Unit: Viscosity').selectOption('mm²/s');
  await page.getByText('Units', { exact: true }).click();
  for (const map of ['Film map', 'Traction map']) {
    await page.getByRole('button', { name: map }).click();
    await page.getByRole('region', { name: 'Numbers of the map' }).waitFor();
    assert.deepEqual(await foreignNumbers(page), []);
  }
  assert.match(new URL(page.url()).search, /tab=traction/);
});

test('what another project has is not found, in the words of what does not exist', async () => {
  const token = await server.newToken('bert', '--projects', 'axles');
  const other = await newPage(browser, server);
  await other.goto(`${server.address}/jobs/1`);
  await signIn(other, token);
  await other.waitForURL(/\/p\/axles\//);
  await other.getByRole('link', { name: 'Lubricant 1' }).waitFor();
  assert.equal(await other.getByText('My oil').count(), 0);
  other.expect(404, 'lubricants/my-oil');
  await other.goto(`${server.address}/p/axles/fluids/my-oil`);
  await other.getByRole('heading', { name: 'Nothing is here' }).waitFor();
  await other.context().close();
});

test('fluids are found by words of their names or by a filter, and sorted, and say how their parameters are known', async () => {
  await server.newOil('thin-oil', 'Thin oil', 40, 7, 850);
  await page.goto(`${server.address}/fluids`);
  const names = () => page.getByRole('region', { name: 'Fluids' }).locator('tbody a').allTextContents();
  const found = (count) => page.waitForFunction((wanted) => !document.querySelector('.stale') && document.querySelectorAll('tbody tr').length === wanted, count);
  const search = async (text) => {
    await page.getByLabel('Search names').fill(text);
    await page.getByLabel('Search names').press('Enter');
  };
  await page.getByRole('row', { name: /Thin oil/ }).getByText('assumed, derived, fitted').waitFor();
  await search('thin');
  await found(1);
  assert.deepEqual(await names(), ['Thin oil']);
  await search('kv100 > 14.5 AND display_name : Lubricant');
  await found(2);
  await page.getByRole('button', { name: 'KV100' }).click();
  await page.waitForURL(/q=kv100.*sort=kv100$/);
  await page.locator('th[aria-sort="ascending"]').waitFor();
  await found(2);
  assert.deepEqual(await names(), ['Lubricant 2', 'Lubricant 1']);
  await page.getByRole('button', { name: 'KV100' }).click();
  await page.waitForFunction(() => document.querySelector('tbody a')?.textContent === 'Lubricant 1');
  await page.reload();
  await found(2);
  assert.deepEqual(await names(), ['Lubricant 1', 'Lubricant 2']);
  page.expect(400, 'filter=lims');
  await search('lims = 4');
  await page.locator('.search .problem', { hasText: '"lims" is not a field of a filter' }).waitFor();
  await search('no such oil');
  await page.getByRole('button', { name: 'Show all fluids' }).click();
  await page.getByText('Thin oil').waitFor();
});
