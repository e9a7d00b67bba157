// Every view in both themes and at two widths: axe finds nothing serious, nothing is cut off, and a
// screenshot of each is left in build/web/screenshots.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';
import { campaignOf, launch, newPage, Server, signIn } from './harness.mjs';

const AXE = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const FOLDER = 'screenshots';

export let browser;
export let server;
before(async () => {
  mkdirSync(FOLDER, { recursive: true });
  browser = await launch();
  server = await new Server().start();
  await server.newOil('my-oil', 'My oil', 103, 15.1, 868);
  await server.newOil('their-oil', 'Their oil', 95, 12.4, 862);
  const create = (body) => server.call('POST', '/v1/simulations', body);
  for (const fluid of [1, 2, 3]) {
    await create({
      lubricant: `lubricants/paper-fluid-${fluid}`,
      inefficiency_curve: { first_speed_kilometres_per_hour: 20, last_speed_kilometres_per_hour: 140, speed_step_kilometres_per_hour: 5 },
    });
  }
  const point = (speed) => ({
    lubricant: 'lubricants/paper-fluid-1',
    operating_point: {
      cruise: { speed_kilometres_per_hour: speed }, sensitivities: true,
      history: {
        columns: ['mesh_phase_cycles', 'dynamic_transmission_error_metres', 'dynamic_transmission_error_velocity_metres_per_second', 'mesh_force_newtons', 'pinion_friction_torque_newton_metres', 'flank_load_newtons', 'flank_film_ratio', 'flank_contact_temperature_kelvin'],
        mesh_cycles: 2, samples_per_mesh_cycle: 960,
      },
    },
  });
  await create(point(75));
  await create({
    lubricant: 'lubricants/paper-fluid-2', sump_temperature_celsius: 90, deadline_seconds: 0.01,
    solver_options: { method: 'STEADY_STATE_METHOD_MARCH' },
    inefficiency_curve: { first_speed_kilometres_per_hour: 20, last_speed_kilometres_per_hour: 60, speed_step_kilometres_per_hour: 1 },
  });
  await create({
    lubricant: 'lubricants/my-oil',
    inefficiency_curve: { first_speed_kilometres_per_hour: 20, last_speed_kilometres_per_hour: 140, speed_step_kilometres_per_hour: 5 },
  });
  await create(point(60));
  await server.call('POST', '/v1/campaigns', campaignOf(30, { contact_figures: true }));
  for (let i = 0; i < 100; ++i) {
    const { simulations } = await server.call('GET', '/v1/simulations?read_mask=state');
    if (simulations.every((each) => each.state === 'SUCCEEDED' || each.state === 'FAILED')) break;
    await new Promise((done) => setTimeout(done, 100));
  }
});
after(async () => {
  await browser?.close();
  await server?.remove();
});

/** Name, address, what is there once the view is complete, and what is clicked then. */
const VIEWS = [
  ['home', '/', '.runs li'],
  ['curves', '/curves?r=1,2,3', '.multiple canvas'],
  ['curves-dte', '/curves?r=1,2,3&y=dte', '.multiple canvas'],
  ['curves-form', '/curves?f=paper-fluid-1', '.empty'],
  ['curves-bands', '/curves?r=1,6', '.verdicts li'],
  ['curves-split', '/curves?r=1,2,3&y=split', '.verdicts li'],
  ['compare', '/compare?a=my-oil&b=their-oil', '.bars'],
  ['compare-exact', '/compare?a=paper-fluid-1&b=paper-fluid-2', '.bars'],
  ['fluids', '/fluids', 'tbody tr'],
  ['fluid', '/fluids/paper-fluid-1', '.parameters tbody tr'],
  ['fluid-viscosity', '/fluids/my-oil?tab=viscosity&vs=paper-fluid-1', '.u-over'],
  ['fluid-map', '/fluids/my-oil?tab=traction', '.scatter canvas'],
  ['fluid-new', '/fluids/new', '.drop'],
  ['fluid-edit', '/fluids/paper-fluid-1/edit', '.fluid-form'],
  ['jobs', '/jobs', 'tbody tr'],
  ['job', '/jobs/5', '.facts'],
  ['job-assumptions', '/jobs/1', '.assumptions'],
  ['point', '/point/4', '.pair canvas'],
  ['point-smooth', '/point/7', '.bars'],
  ['campaigns', '/campaigns', 'tbody tr'],
  ['campaign-new', '/campaigns/new', '.drop'],
  ['campaign-new-table', '/campaigns/new?contact=1', '.drop', 'Show an example', '.estimate strong'],
  ['campaign-new-design', '/campaigns/new?from=design', '.design'],
  ['campaign-new-fluids', '/campaigns/new?from=fluids&of=my-oil,their-oil', '.estimate strong'],
  ['campaign-append', '/campaigns/1/append', '.drop'],
  ['campaign-ranking', '/campaigns/1', '.ranking tbody tr'],
  ['campaign-pareto', '/campaigns/1?view=pareto', '.scatter canvas'],
  ['campaign-effects', '/campaigns/1?view=effects', '.bars'],
  ['campaign', '/campaigns/1?view=rows&order=mesh_loss_power_watts&c=7', '.rows tbody tr'],
  ['campaign-plot', '/campaigns/1?view=plot&x=cost_euros_per_kilogram&color=additive', '.scatter canvas'],
  ['campaign-parallel', '/campaigns/1?view=parallel&b=mesh_loss_power_watts:12..20', '.parallel-axis'],
  ['cycles', '/cycles', '.over-time canvas'],
  ['cycles-own', '/cycles?cycle=own', '.drop'],
  ['rigs', '/rigs', '.read-out'],
  ['rigs-film', '/rigs?kind=film', '.read-out'],
  ['paper', '/paper', '.places'],
  ['more', '/more', '.places'],
  ['missing', '/fluids/no-such-oil', '.empty'],
];

/** Rules of axe that are never serious: they are left out, as they take a third of its time. */
const MINOR = ['region', 'landmark-banner-is-top-level', 'landmark-contentinfo-is-top-level', 'landmark-main-is-top-level',
  'landmark-no-duplicate-banner', 'landmark-no-duplicate-contentinfo', 'landmark-no-duplicate-main', 'landmark-one-main', 'landmark-unique',
  'page-has-heading-one', 'heading-order', 'skip-link', 'empty-heading', 'empty-table-header', 'image-redundant-alt', 'meta-viewport-large'];
const OPTIONS = { resultTypes: ['violations'], rules: Object.fromEntries(MINOR.map((each) => [each, { enabled: false }])) };

/** Follows a link of the page, by way of a view without content of its own: nothing of the view before is left. */
async function follow(page, path) {
  for (const each of ['/more', path]) {
    await page.evaluate((href) => {
      const link = Object.assign(document.createElement('a'), { href });
      document.querySelector('main').append(link);
      link.click();
      link.remove();
    }, each);
    if (each === '/more') await page.locator('.places a[href="/paper"]').waitFor();
    else if (path !== '/more') await page.locator('.places a[href="/paper"]').waitFor({ state: 'detached' });
  }
}

/** Opens and closes the menu of a view: all of it lies within the window. */
async function checkMenu(page, width, problems) {
  await page.getByText('Take away').click();
  const { x, y, width: wide, height } = await page.locator('.menu[open] .menu-body').boundingBox();
  if (x < 0 || x + wide > width || y < 0 || y + height > 900) problems.push(`the menu lies at ${x}, ${y} and is ${wide} by ${height} pixels large`);
  await page.getByText('Take away').click();
}

/**
 * Tests every view in a theme. The themes are files of their own, which run beside each other. In one of
 * the runs each address is loaded afresh, in the others its view is reached by a link.
 */
export function testViews(colorScheme) {
  for (const width of [1280, 390]) {
    test(`every view is readable in the ${colorScheme} theme at ${width} pixels`, async () => {
      const page = await newPage(browser, server, { viewport: { width, height: 900 }, colorScheme });
      await page.goto(server.address);
      await page.screenshot({ path: `${FOLDER}/sign-in-${colorScheme}-${width}.png` });
      await signIn(page, server.token);
      page.expect(404, 'lubricants/no-such-oil');
      const isAfresh = colorScheme === 'dark' && width === 1280;
      if (!isAfresh) await page.evaluate(AXE);
      const problems = [];
      for (const [name, path, mark, words, next] of VIEWS) {
        if (isAfresh) await page.goto(server.address + path);
        else await follow(page, path);
        await page.locator(mark).first().waitFor();
        if (words) {
          await page.getByRole('button', { name: words }).click();
          await page.locator(next).first().waitFor();
        }
        await page.waitForFunction(() => !document.querySelector('.stale'));
        await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
        await page.screenshot({ path: `${FOLDER}/${name}-${colorScheme}-${width}.png`, fullPage: true });
        const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        if (overflow > 0) problems.push(`${name}: ${overflow} pixels wider than the window`);
        if (name === 'compare') await checkMenu(page, width, problems);
        if (colorScheme === 'dark' && width === 390) continue; // its colors and its layout are looked at above
        if (isAfresh) await page.evaluate(AXE);
        const { violations } = await page.evaluate((options) => axe.run(document, options), OPTIONS);
        for (const each of violations) {
          if (!['serious', 'critical'].includes(each.impact)) continue;
          problems.push(`${name}: ${each.id}: ${each.help}: ${each.nodes.slice(0, 2).map((node) => node.html.slice(0, 160)).join(' | ')}`);
        }
      }
      assert.deepEqual(problems, []);
      await page.context().close();
    });
  }
}
