// How smoothly a plot of 50 curves of 500 points moves: prints frames a second and the time of frames.
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
  await page.mouse.move(middle.x, middle.y);
  await page.keyboard.down('Shift');
  await page.mouse.down();
  // The browser itself moves the pointer once a frame: messages of the test would be the bottleneck.
  const frames = await page.evaluate(async ({ x, y, width, seconds }) => {
    const target = document.querySelector('.figure .u-over');
    const frames = [];
    const work = [];
    const begin = performance.now();
    for (let last = begin; ;) {
      const now = await new Promise(requestAnimationFrame);
      frames.push(now - last);
      last = now;
      if (now - begin > 1000 * seconds) break;
      const before = performance.now();
      const clientX = x + 0.4 * width * Math.sin((now - begin) / 400);
      target.dispatchEvent(new PointerEvent('pointermove', { clientX, clientY: y, shiftKey: true, bubbles: true }));
      await null; // uPlot paints at the end of the task
      work.push(performance.now() - before);
    }
    return { frames: frames.slice(1), work };
  }, { ...middle, width: plot.width, seconds: SECONDS });
  await page.mouse.up();
  await page.keyboard.up('Shift');
  const at = (values, share) => [...values].sort((a, b) => a - b)[Math.floor(share * (values.length - 1))];
  const total = frames.frames.reduce((a, b) => a + b);
  console.log(`${CURVES} curves of ${POINTS} points: ${((1000 * frames.frames.length) / total).toFixed(1)} frames a second; ` +
    `frame ${at(frames.frames, 0.5).toFixed(1)} ms (median), ${at(frames.frames, 0.95).toFixed(1)} ms (95 %); ` +
    `script ${at(frames.work, 0.5).toFixed(1)} ms (median), ${at(frames.work, 0.95).toFixed(1)} ms (95 %)`);
  if (page.complaints.length > 0) throw new Error(page.complaints.join('\n'));
} finally {
  await browser.close();
  await server.remove();
}
