// film.mjs FOLDER FRAMES_PER_SECOND SECONDS: pictures of the page's window at a fixed time step, FOLDER/0000.png and
// on, while a hand clicks through what the page can do. Time is that of the match: a slow machine takes longer.
import { BUILT, launch, serve } from './browser.mjs';

const [folder, rate, length] = process.argv.slice(2);
const [fps, seconds] = [rate, length].map(Number);
const PATIENCE = { timeout: 600000, polling: 50 };
// Quality: of "medium", with the picture's own pixels.
const LOOK = { pixels: 1, samples: 4, scale: 0.5, stepScale: 1.4, lightFraction: 1 / 4 };

const click = selector => page => page.$eval(selector, element => element.click());
const at = (x, y) => page => page.mouse.click(x, y);
const look = (eye, target) => page => page.evaluate((...from) => window.page.lookFrom(...from), eye, target);
const lose = percent => page =>
  page.$eval(
    '#loss',
    (slider, value) => {
      slider.value = value;
      slider.dispatchEvent(new Event('input'));
    },
    percent
  );
// [seconds, what the hand does]; the page's own opening comes first.
const ACTS = [
  [5.9, click('#tool-shoot')],
  [6.1, at(520, 500)],
  [6.25, at(600, 520)],
  [6.4, at(680, 500)],
  [7.1, click('#tool-blast')],
  [7.4, at(520, 560)],
  [8.3, look([-4.3, 1.5, 8.2], [-2.3, 1.5, 0])],
  [8.3, click('#tool-throw')],
  [8.4, at(640, 400)],
  [8.7, click('#open')],
  [9.5, click('#door-front')],
  [10.2, lose(30)],
  [10.2, click('#split')],
  [10.3, look([-5.7, 1.4, 10.2], [-0.75, 2.55, -0.6])],
  [10.6, click('#open')],
  [10.8, click('#door-front')],
  [11.0, click('#tool-word')],
  [11.2, at(320, 440)]
];

/** Stops the page's clock. */
async function stop(page) {
  await page.waitForFunction('window.page?.match?.report', PATIENCE);
  await page.evaluate(look => {
    window.page.renderer.setAnimationLoop(null);
    Object.assign(window.page.quality.step, look);
    window.page.match.isPlaying = true;
  }, LOOK);
  await page.waitForFunction('!window.page.match.isBusy', PATIENCE);
}

/** One step of the page and of what moves in its window. */
const step = (page, milliseconds) =>
  page.evaluate(async ms => {
    const { page } = window;
    page.frame(page.before + ms);
    while (page.match.isBusy) await new Promise(later => setTimeout(later, 1));
    for (const animation of document.getAnimations()) {
      animation.pause();
      animation.currentTime = Number(animation.currentTime ?? 0) + ms;
      if (animation.currentTime >= animation.effect.getComputedTiming().endTime) animation.finish();
    }
  }, milliseconds);

const files = await serve(`${BUILT}page`),
  browser = await launch();
const page = await browser.newPage();
await page.setViewport({ width: 1280, height: 720 });
await page.goto(`${files.url}/?quality=medium&paused`);
await stop(page);
const acts = [...ACTS];
for (let frame = 0; frame < Math.round(fps * seconds); ++frame) {
  while (acts.length > 0 && acts[0][0] <= frame / fps) await acts.shift()[1](page);
  await step(page, 1000 / fps);
  await page.screenshot({ path: `${folder}/${String(frame).padStart(4, '0')}.png` });
}
await browser.close();
files.close();
