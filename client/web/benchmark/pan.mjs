// How smoothly a plot of 50 curves of 500 points moves, and its table of numbers follows the pointer: prints frames a second, and what a frame takes
// of the scripts of the page and of its main thread. Frames depend on how fast the machine paints: a
// processor that paints in software and compiles beside it draws fewer than a graphics processor. The
// time of scripts hardly does.
// usage, after deploy/build-dashboard, from build/web: TRIBODYND=... node benchmark/pan.mjs
import { launch, newPage, Server, signIn } from '../tests/harness.mjs';

const CURVES = 50;
const POINTS = 500;
const SECONDS = 3;

const server = await new Server().start();
const browser = await launch();
try {
  const ids = [];
  for (let i = 0; i < CURVES; ++i) {
    await server.newOil(`oil-${i}`, `Oil ${i}`, 60 + 2 * i, 9.5 + 0.25 * i, 860);
    const { name } = await server.call('POST', '/v1/simulations', {
      lubricant: `lubricants/oil-${i}`,
      inefficiency_curve: {
        speeds_kilometres_per_hour: Array.from({ length: POINTS }, (_, k) => 20 + (120 * k) / (POINTS - 1)),
        independent_points: true, model: 'POINT_MODEL_QUASI_STATIC',
      },
    });
    ids.push(name.split('/')[1]);
  }
  for (;;) {
    const { simulations } = await server.call('GET', `/v1/simulations?page_size=${CURVES}&read_mask=state`);
    if (simulations.every((each) => each.state === 'SUCCEEDED')) break;
    await new Promise((done) => setTimeout(done, 200));
  }
  const page = await newPage(browser, server);
  page.setDefaultTimeout(120_000);
  await page.goto(`${server.address}/curves?r=${ids.join(',')}&x=50-90`);
  await signIn(page, server.token);
  await page.waitForFunction((count) => document.querySelectorAll('.read-out tbody tr').length === count, CURVES);
  await page.waitForTimeout(1000);
  const plot = await page.locator('.figure .u-over').first().boundingBox();
  const middle = { x: plot.x + plot.width / 2, y: plot.y + plot.height / 2 };
  const at = (values, share) => [...values].sort((a, b) => a - b)[Math.floor(share * (values.length - 1))];
  /** Moves the pointer once a frame and prints what the frames take. */
  const measure = async (words, kind) => {
    await browser.startTracing(page, { categories: ['toplevel', 'devtools.timeline'] });
    // The browser itself moves the pointer: messages of the test would be the bottleneck.
    const frames = await page.evaluate(async ({ x, y, width, seconds, kind }) => {
      const target = document.querySelector('.figure .u-over');
      const frames = [];
      const begin = performance.now();
      for (let last = begin; ;) {
        const now = await new Promise(requestAnimationFrame);
        frames.push(now - last);
        last = now;
        if (now - begin > 1000 * seconds) break;
        const clientX = x + 0.4 * width * Math.sin((now - begin) / 400);
        const where = { clientX, clientY: y, bubbles: true };
        target.dispatchEvent(kind === 'pan' ? new PointerEvent('pointermove', { ...where, shiftKey: true }) : new MouseEvent('mousemove', where));
      }
      return frames.slice(1);
    }, { ...middle, width: plot.width, seconds: SECONDS, kind });
    const { traceEvents } = JSON.parse((await browser.stopTracing()).toString());
    // Time of the processor, not of the clock: other programs do not lengthen it.
    const main = traceEvents.find((each) => each.name === 'FireAnimationFrame');
    const perFrame = (...names) => (traceEvents.filter((each) => each.pid === main.pid && each.tid === main.tid && names.includes(each.name))
      .reduce((sum, each) => sum + (each.tdur ?? 0), 0) / 1000 / frames.length).toFixed(1);
    const total = frames.reduce((a, b) => a + b);
    console.log(`${words}, ${CURVES} curves of ${POINTS} points: ${((1000 * frames.length) / total).toFixed(1)} frames a second; ` +
      `frame ${at(frames, 0.5).toFixed(1)} ms (median), ${at(frames, 0.95).toFixed(1)} ms (95 %); ` +
      `per frame ${perFrame('FireAnimationFrame', 'TimerFire')} ms of scripts, ${perFrame('ThreadControllerImpl::RunTask')} ms of the main thread (means)`);
  };
  await page.mouse.move(middle.x, middle.y);
  await measure('the table follows the pointer', 'hover');
  await page.keyboard.down('Shift');
  await page.mouse.down();
  await measure('the plot is moved', 'pan');
  await page.mouse.up();
  await page.keyboard.up('Shift');
  if (page.complaints.length > 0) throw new Error(page.complaints.join('\n'));
} finally {
  await browser.close();
  await server.remove();
}
