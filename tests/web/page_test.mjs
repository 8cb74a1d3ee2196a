// The page of examples/web in headless Chromium: clicks, touches and pictures. Times are of the match, not of a clock.
import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { BUILT, launch, serve } from './browser.mjs';

const WIDTH = 800,
  HEIGHT = 480,
  TICKS = 64;
const PATIENCE = { timeout: 300000, polling: 100 };
const MOST_BYTES = 4e6;
// Places of the window: the front door in the camera's first view, and the middle.
const DOOR = [333, 292],
  MIDDLE = [WIDTH / 2, HEIGHT / 2];

let browser, files, page, errors, hosts;
before(async () => {
  files = await serve(`${BUILT}page`);
  browser = await launch();
});
after(async () => {
  await page?.close();
  await browser?.close();
  files?.close();
});

async function open(query = 'empty&quality=lowest', flags = {}) {
  await page?.close();
  page = await browser.newPage();
  errors = [];
  hosts = new Set();
  page.on('pageerror', error => errors.push(error.message));
  page.on('console', message => {
    if (message.type() === 'error') errors.push(message.text());
  });
  page.on('request', request => {
    if (!request.url().startsWith('blob:')) hosts.add(new URL(request.url()).origin);
  });
  await page.setViewport({ width: WIDTH, height: HEIGHT, ...flags });
  await page.goto(`${files.url}/?${query}`);
  await page.waitForFunction('window.page?.match?.report || document.querySelector("#cover.failed")', PATIENCE);
}

const until = (condition, ...given) => page.waitForFunction(condition, PATIENCE, ...given);
const untilTick = tick => until(wanted => window.page.match.tick >= wanted, tick);
const match = () =>
  page.evaluate(() => {
    const { tick, latest, shut, sight, report } = window.page.match;
    return { tick, latest, shut, sight, report };
  });

/** Luminance of the picture without what surrounds it, rows from the top. */
const picture = () =>
  page.evaluate(() => {
    const { renderer } = window.page,
      gl = renderer.getContext();
    window.page.frame(performance.now());
    const { drawingBufferWidth: width, drawingBufferHeight: height } = gl,
      bytes = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    const light = Array.from({ length: width * height }, (_, i) => {
      const at = 4 * ((i % width) + width * (height - 1 - Math.floor(i / width)));
      return (bytes[at] + bytes[at + 1] + bytes[at + 2]) / 765;
    });
    return { width, height, light };
  });

/** The fraction of pixels in a box of the window, [left, top, right, bottom], that differ by more than 4 %. */
function changed(a, b, box = [0, 0, WIDTH, HEIGHT]) {
  const scale = a.width / WIDTH,
    [left, top, right, bottom] = box.map(at => Math.round(at * scale));
  let count = 0;
  for (let y = top; y < bottom; ++y)
    for (let x = left; x < right; ++x)
      count += Math.abs(a.light[x + a.width * y] - b.light[x + a.width * y]) > 0.04 ? 1 : 0;
  return count / ((right - left) * (bottom - top));
}

/** A match without events, and the first view, in the page that is there. */
async function restart() {
  if (!page || page.isClosed()) return open();
  const clears = await page.evaluate(() => window.page.match.restart());
  await until(wanted => window.page.match.clears === wanted, clears);
  await page.evaluate(() => window.page.lookFrom());
  await page.click('#tool-throw');
}

beforeEach(restart);
const noErrors = () => assert.deepEqual(errors, []);

test('it takes at most 4 MB, all from one host', async () => {
  const loaded = await browser.newPage(),
    client = await loaded.createCDPSession();
  let bytes = 0;
  await client.send('Network.enable');
  client.on('Network.loadingFinished', event => {
    bytes += event.encodedDataLength;
  });
  await loaded.goto(files.url);
  await loaded.waitForFunction('window.page?.match?.report', PATIENCE);
  await loaded.close();
  assert.ok(bytes < MOST_BYTES, `${bytes} bytes`);
  assert.deepEqual([...hosts], [files.url]);
  noErrors();
});

test('a throw fills the picture with smoke, a shot bores a hole, a blast clears it', async () => {
  await untilTick(4);
  const empty = await picture();
  assert.ok(
    empty.light.some(value => value > 0.5),
    'the house is lit'
  );
  await page.mouse.click(...DOOR);
  await until(() => window.page.match.report.clouds === 1);
  const { tick } = await match();
  await untilTick(tick + 2 * TICKS);
  const smoky = await picture();
  assert.ok(changed(empty, smoky) > 0.02, `${changed(empty, smoky)} of the picture`);

  await page.click('#tool-shoot');
  await page.mouse.click(...DOOR);
  await until(() => window.page.match.report.holes === 1);
  const shot = (await match()).tick;
  await untilTick(shot + 24);
  const around = [DOOR[0] - 10, DOOR[1] - 10, DOOR[0] + 10, DOOR[1] + 10];
  const pierced = changed(smoky, await picture(), around);
  assert.ok(pierced > 0.03, `${pierced} around the shot`);

  await page.click('#tool-blast');
  await page.mouse.click(...DOOR);
  await until(() => window.page.match.report.blasts === 1);
  noErrors();
});

test('smoke, doors and the past decide who sees whom', async () => {
  await untilTick(2);
  assert.equal((await match()).sight, 'sees');
  await page.evaluate(() => document.getElementById('door-front').click());
  await until(() => window.page.match.sight === 'wall');
  assert.deepEqual((await match()).shut, [true, false, false]);
  await page.evaluate(() => document.getElementById('door-front').click());
  await until(() => window.page.match.sight === 'sees');
  await page.mouse.click(...DOOR);
  await until(() => window.page.match.sight === 'smoke');
  await until(() => document.getElementById('sight').textContent.startsWith('Smoke'));
  // Also through the smoke as it is drawn.
  await page.evaluate(() => document.getElementById('drawn').click());
  await untilTick((await match()).tick + TICKS);
  assert.equal((await match()).sight, 'smoke');

  // Back to the first tick, and forwards again: the same smoke.
  const then = await match();
  const seek = tick =>
    page.$eval(
      '#slider',
      (slider, value) => {
        slider.value = value;
        slider.dispatchEvent(new Event('input'));
      },
      tick
    );
  await seek(1);
  await until(() => window.page.match.tick === 1 && window.page.match.sight === 'sees');
  await seek(then.tick);
  await until(tick => window.page.match.tick === tick && window.page.match.sight === 'smoke', then.tick);
  assert.equal((await match()).report.hashes[0], then.report.hashes[0]);
  noErrors();
});

test('two players have the same hashes although packets are lost', async () => {
  await page.$eval('#loss', slider => {
    slider.value = 30;
    slider.dispatchEvent(new Event('input'));
  });
  await page.mouse.click(...DOOR);
  await page.evaluate(() => document.getElementById('split').click());
  const begun = (await match()).report;
  let equal = 0,
    tick = (await match()).tick;
  for (let i = 0; i < 12; ++i) {
    await untilTick((tick += 16));
    const { report } = await match();
    assert.equal(report.hashes[1], report.serverThen, `at tick ${report.ticks[1]}`);
    assert.ok(report.ticks[0] - report.ticks[1] < 2 * TICKS, 'the player follows');
    equal += 1;
  }
  assert.equal(equal, 12);
  const { report } = await match(),
    lost = (report.lost - begun.lost) / (report.packets - begun.packets);
  assert.ok(lost > 0.2 && lost < 0.4, `${lost} of the packets are lost`);
  // Both see the same smoke, but for what is under way.
  const { width, height, light } = await picture(),
    half = width / 2;
  let apart = 0;
  for (let y = 0; y < height; ++y)
    for (let x = 4; x < half - 4; ++x)
      apart +=
        Math.abs(light[Math.floor(x) + width * y] - light[Math.floor(x + half) + width * y]) /
        (height * (half - 8));
  assert.ok(apart < 0.03, `${apart} apart`);
  noErrors();
});

test('a letter in smoke is read as itself among the alphabet', async () => {
  await open('empty&quality=medium');
  await page.evaluate(() => {
    window.page.lookFrom([2.9, 1.5, 14], [2.9, 1.6, 0]);
    window.page.match.act({ kind: 'throw', from: [2.9, 1.6, 9], at: [2.9, 0.2, 4.6], amount: 75 });
  });
  await until(() => window.page.match.report.clouds === 1);
  await untilTick((await match()).tick + 3 * TICKS);
  await page.click('#tool-word');
  await page.$eval('#word', input => {
    input.value = 'R';
  });
  await page.mouse.click(...MIDDLE);
  await until(() => window.page.match.report.holes === 1);
  await untilTick((await match()).tick + 32);
  const best = await page.evaluate(
    ([x, y]) => {
      // What the smoke lets through, from the image of the march, rows from the bottom.
      const { renderer, views } = window.page,
        gl = renderer.getContext();
      window.page.frame(performance.now());
      renderer.setRenderTarget(views[0].march);
      const { width, height } = views[0].march,
        rgba = new Float32Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, rgba);
      const { masks, texels } = window.page.letters,
        middle = [Math.round(x * width), Math.round((1 - y) * height)];
      const correlation = (mask, left, bottom, edge) => {
        const sums = [0, 0, 0, 0, 0, 0];
        for (let y = 0; y < edge; ++y)
          for (let x = 0; x < edge; ++x) {
            const row = Math.floor(((edge - 1 - y + 0.5) / edge) * texels),
              u = mask[Math.floor(((x + 0.5) / edge) * texels) + texels * row] / 255,
              v = rgba[4 * (left + x + width * (bottom + y)) + 3];
            [1, u, v, u * u, v * v, u * v].forEach((term, i) => (sums[i] += term));
          }
        const [n, a, b, aa, bb, ab] = sums;
        return (n * ab - a * b) / Math.sqrt((n * aa - a * a) * (n * bb - b * b) + 1e-9);
      };
      // How well it is correlated with each letter, at the best of sizes and places.
      const scores = masks.slice(0, 26).map((mask, letter) => {
        let score = 0;
        for (let edge = 16; edge <= 60; edge += 2)
          for (const dy of [-4, -2, 0, 2, 4])
            for (const dx of [-4, -2, 0, 2, 4])
              score = Math.max(score, correlation(mask, middle[0] + dx - edge / 2, middle[1] + dy - edge / 2, edge));
        return { letter: String.fromCharCode(65 + letter), score };
      });
      return scores.sort((a, b) => b.score - a.score).slice(0, 3);
    },
    [MIDDLE[0] / WIDTH, MIDDLE[1] / HEIGHT]
  );
  assert.equal(best[0].letter, 'R', JSON.stringify(best));
  assert.ok(best[0].score > 0.4, JSON.stringify(best));
  noErrors();
});

test('it works by touch', async () => {
  await open('empty&quality=lowest', { width: 360, height: 640, hasTouch: true, isMobile: true });
  await untilTick(2);
  const tap = async selector => {
    const box = await (await page.$(selector)).boundingBox();
    await page.touchscreen.tap(box.x + box.width / 2, box.y + box.height / 2);
  };
  await page.touchscreen.tap(180, 330);
  await until(() => window.page.match.report.clouds === 1);
  await tap('#tool-shoot');
  assert.equal(await page.$eval('#tool-shoot', button => button.getAttribute('aria-pressed')), 'true');
  await untilTick((await match()).tick + 2 * TICKS);
  await page.touchscreen.tap(180, 330);
  await until(() => window.page.match.report.holes > 0);
  // A finger that moves looks around, and shoots nothing.
  const before = await page.evaluate(() => window.page.views[0].camera.position.toArray());
  await page.touchscreen.touchStart(180, 300);
  for (let x = 190; x <= 260; x += 10) await page.touchscreen.touchMove(x, 300);
  await page.touchscreen.touchEnd();
  await until(x => Math.abs(window.page.views[0].camera.position.x - x) > 0.1, before[0]);
  await tap('#open');
  await until(() => document.querySelector('#panel.shown'));
  noErrors();
});

test('two fingers come closer, and throw nothing', async () => {
  await open('empty&quality=lowest', { width: 390, height: 844, hasTouch: true, isMobile: true });
  await untilTick(2);
  const client = await page.createCDPSession();
  const touch = (type, ...places) =>
    client.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: places.map(([x, y], id) => ({ x, y, id }))
    });
  const away = () => page.evaluate(() => window.page.views[0].camera.position.distanceTo(window.page.controls.target));
  const before = await away();
  await touch('touchStart', [180, 400]);
  await touch('touchStart', [180, 400], [220, 400]);
  for (let d = 0; d <= 100; d += 20) await touch('touchMove', [180 - d, 400], [220 + d, 400]);
  await touch('touchEnd', [80, 400]);
  await touch('touchEnd');
  await until(far => {
    const { views, controls } = window.page;
    return views[0].camera.position.distanceTo(controls.target) < far - 0.2;
  }, before);
  await untilTick((await match()).tick + TICKS);
  assert.equal((await match()).report.clouds, 0);
  // Both players fit into a high window, one below the other.
  await page.evaluate(() => document.getElementById('split').click());
  await until(() => window.page.areas.length === 2 && window.page.areas[1].y > 400);
  noErrors();
});

test('without a click there is smoke with holes and a word, then it invites', async () => {
  await open('quality=lowest');
  await until(() => window.page.match.report.clouds === 2);
  await until(() => window.page.match.report.holes >= 5);
  await until(() => !document.getElementById('hint').hidden);
  const { tick } = await match();
  assert.ok(tick < 7 * TICKS, `the invitation comes at tick ${tick}`);
  await page.mouse.click(...MIDDLE);
  assert.ok(await page.$eval('#hint', hint => hint.hidden));
  await until(() => window.page.match.report.clouds === 3);
  noErrors();
});

test('a hundred shots at once, and a slider that is dragged about, leave the match whole', async () => {
  await page.mouse.click(...DOOR);
  await until(() => window.page.match.report.clouds === 1);
  await page.evaluate(
    ([x, y]) => {
      window.page.face.choose('shoot');
      for (let i = 0; i < 100; ++i) window.page.act(x - 50 + i, y - 20 + (i % 40));
    },
    DOOR
  );
  await until(() => window.page.match.report.holes === 100);
  const then = await match();
  await page.evaluate(async last => {
    const slider = document.getElementById('slider');
    const to = tick => {
      slider.value = tick;
      slider.dispatchEvent(new Event('input'));
    };
    for (let i = 0; i < 300; ++i) {
      to((i * 7919) % (last + 1));
      if (i % 10 === 0) await new Promise(requestAnimationFrame);
    }
    to(last);
  }, then.tick);
  await until(tick => window.page.match.tick === tick && !window.page.match.isBusy, then.tick);
  assert.equal((await match()).report.hashes[0], then.report.hashes[0]);
  noErrors();
});

test('a device that loses the picture gets it again', async () => {
  await page.mouse.click(...DOOR);
  await until(() => window.page.match.report.clouds === 1);
  await untilTick((await match()).tick + 2 * TICKS);
  await page.click('#play');
  await until(() => !window.page.match.isBusy);
  const before = await picture();
  await page.evaluate(() => {
    window.lost = window.page.renderer.getContext().getExtension('WEBGL_lose_context');
    window.lost.loseContext();
  });
  await page.waitForSelector('#cover.failed', PATIENCE);
  await page.evaluate(() => window.lost.restoreContext());
  await page.waitForSelector('#cover.done', PATIENCE);
  const answers = await page.evaluate(() => window.page.answers);
  await until(count => window.page.answers > count + 1, answers);
  const apart = changed(before, await picture());
  assert.ok(apart < 0.02, `${apart} of the picture`);
  // Chromium itself reports the loss.
  errors = errors.filter(error => !error.includes('CONTEXT_LOST'));
  noErrors();
});

test('quality falls where frames take too long', async () => {
  await open('empty');
  await until(() => ['low', 'lowest'].includes(window.page.quality.step.name));
  noErrors();
});

test('without WebGL 2 it says so in one sentence', async () => {
  const without = await launch(['--disable-3d-apis']);
  const blind = await without.newPage();
  await blind.goto(files.url);
  await blind.waitForSelector('#cover.failed', PATIENCE);
  const text = await blind.$eval('#message', element => element.textContent);
  await without.close();
  assert.match(text, /^This page draws with WebGL 2, [^.]*\.$/);
});
