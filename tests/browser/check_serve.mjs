// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Usage: node check_serve.mjs LANTHORN SCENE [SCREENSHOT-FOLDER]
// Opens the page of lanthorn serve in headless Chromium and uses it like a person. Exit code 77 if the browser or playwright-core
// is missing: the test is skipped.
import {spawn} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

const [program, scene, screenshots] = process.argv.slice(2);
const skip = (why) => {
  console.log(`SKIPPED: ${why}`);
  process.exit(77);
};
const browserPath = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync);
if (!browserPath) skip('no chromium (scripts/install-packages browser)');
const playwright = await import('playwright-core').catch(() => skip('no playwright-core (npm ci in tests/browser)'));

let failures = 0;
const expect = (good, text) => {
  console.log(`${good ? 'ok' : 'FAILED'}: ${text}`);
  if (!good) failures++;
};

const server = spawn(program, ['serve', scene, '--port', '0', '-r', '256x256', '--memory', '512M', '--time', '2h', '-q'], {stdio: ['ignore', 'pipe', 'inherit']});
const address = await new Promise((resolve, reject) => {
  server.stdout.once('data', (text) => resolve(String(text).trim()));
  server.once('exit', () => reject(new Error('the server ended')));
});

const folder = mkdtempSync(join(tmpdir(), 'lanthorn-serve-'));
const context = await playwright.chromium.launchPersistentContext(join(folder, 'profile'), {
  executablePath: browserPath, headless: true, viewport: {width: 1280, height: 800}, colorScheme: 'dark', acceptDownloads: true,
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync']});
const page = context.pages()[0] ?? await context.newPage();
const requests = [];
page.on('request', (request) => requests.push(request.url()));
page.on('pageerror', (problem) => expect(false, `script error: ${problem.message}`));
let hasEnded = false;
page.on('console', (message) => {
  if (message.type() === 'error' && !hasEnded) expect(false, `console: ${message.text()}`);
});

const text = (id) => page.locator(`#${id}`).textContent();
const shot = async (name) => screenshots && page.screenshot({path: join(screenshots, `${name}.png`)});
/// Mean red, green and blue of the canvas.
const mean = () => page.evaluate(() => {
  const canvas = document.getElementById('picture'), sums = [0, 0, 0];
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  for (let i = 0; i < data.length; i++) if (i % 4 < 3) sums[i % 4] += data[i];
  return sums.map((s) => s / (canvas.width * canvas.height));
});
const sum = (a) => a.reduce((x, y) => x + y);
const isRefined = () => page.waitForFunction(() => /^[1-9]/.test(document.getElementById('passes').textContent), null, {timeout: 120000});
async function changes(what, before, read) {
  const start = Date.now();
  while (Date.now() - start < 60000) {
    const now = await read();
    if (JSON.stringify(now) !== JSON.stringify(before)) return expect(true, what);
    await page.waitForTimeout(50);
  }
  expect(false, what);
}

async function drag() {
  const box = await page.locator('#picture').boundingBox(), before = await text('eye');
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 20; i++) {
    await page.mouse.move(x + 4 * i, y + i);
    await page.waitForTimeout(30);
  }
  await shot('dragging');
  await page.mouse.up();
  await changes('dragging moves the camera', before, () => text('eye'));
  await isRefined();
  expect((await page.locator('#command').inputValue()).includes('--look-at'), 'the command line has the camera');
}

async function steerByKeys() {
  await page.locator('#picture').focus();
  for (const [key, what] of [['ArrowLeft', 'turns'], ['Shift+ArrowUp', 'moves'], ['+', 'approaches']]) {
    const before = await text('eye');
    await page.keyboard.press(key);
    await changes(`${key} ${what} the camera`, before, () => text('eye'));
  }
  await page.keyboard.press('Home');
  await page.waitForFunction(() => document.getElementById('home').disabled);
  expect(true, 'Home puts the camera back');
  await isRefined();
}

async function useControls() {
  let before = await mean();
  await page.locator('#exposure').fill('2');
  expect(sum(await mean()) > 1.3 * sum(before), 'exposure brightens at once');
  await shot('exposed');
  await page.locator('#exposure').fill('0');
  before = await mean();
  await page.locator('#curve').selectOption('filmic');
  expect(JSON.stringify(await mean()) !== JSON.stringify(before), 'the filmic curve changes the picture');
  await page.locator('#curve').selectOption('none');
  for (const layer of ['normal', 'depth', 'caustic', 'color']) {
    before = await page.locator('#picture').getAttribute('aria-label');
    await page.locator('#layer').selectOption(layer);
    await page.waitForFunction((name) => document.getElementById('picture').getAttribute('aria-label').includes(`layer ${name}`), layer);
    expect(sum(await mean()) > 0, `layer ${layer} is shown`);
    if (layer === 'normal' || layer === 'depth') await shot(layer);
  }
  before = await mean();
  const light = page.locator('#light-list input').first();
  await light.fill('-2');
  await page.waitForFunction(() => document.getElementById('command').value.includes('--light area1=0.25'));
  await isRefined();
  expect(Math.abs(sum(await mean()) / sum(before) - 0.5) < 0.15, 'a quarter of the light is about half as bright in sRGB');
  await shot('dimmed');
  await page.locator('#lights-reset').click();
  await page.waitForFunction(() => !document.getElementById('command').value.includes('--light'));
}

// Pictures with the old light that arrive while an edit is being sent do not undo the edit.
async function editOnSlowLine() {
  const light = page.locator('#light-list input').first(), frames = [];
  let isSlow = false;
  page.on('response', (response) => { if (isSlow && response.url().includes('/frame?')) frames.push(response); });
  await page.route('**/edit', async (route) => {
    isSlow = true;
    const start = Date.now();
    while (frames.length < 2 && Date.now() - start < 20000) await page.waitForTimeout(50);
    isSlow = false;
    await route.continue();
  });
  await light.fill('-1');
  await page.waitForFunction(() => document.getElementById('command').value.includes('--light area1=0.5'), null, {timeout: 60000});
  expect(await light.inputValue() === '-1', `a light stays as it was set: ${await light.inputValue()}`);
  await page.unroute('**/edit');
  await page.locator('#lights-reset').click();
  await page.waitForFunction(() => !document.getElementById('command').value.includes('--light'));
}

async function readPixels() {
  await page.locator('#layer').selectOption('depth');
  await page.waitForFunction(() => document.getElementById('range').textContent.startsWith('White:'));
  const grey = (await mean())[0];
  expect(grey > 40 && grey < 215, `depth is neither black nor white: ${grey.toFixed(0)} of 255 in the mean, ${await text('range')}`);
  await page.locator('#layer').selectOption('color');
  await page.waitForFunction(() => document.getElementById('range').hidden);
  const box = await page.locator('#picture').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  const before = await text('readout');
  expect(before.startsWith('128, 128'), `the pointer is over the middle: ${before}`);
  await page.locator('#light-list input').first().fill('-3');
  await changes('the values under the pointer follow the picture', before, () => text('readout'));
  await page.locator('#lights-reset').click();
  await page.waitForFunction(() => !document.getElementById('command').value.includes('--light'));
}

async function changeMethodAndSize() {
  const command = (part) => page.waitForFunction((wanted) => document.getElementById('command').value.includes(wanted), part);
  await page.locator('#method').selectOption('path');
  await command('-i path');
  expect(true, 'the method can be changed');
  await page.locator('#width').fill('192');
  await page.locator('#width').press('Tab');
  await command('-r 192x256');
  expect(await page.evaluate(() => document.getElementById('picture').width === 192), 'the width can be changed');
  await shot('resized');
  await page.locator('#width').fill('30000');
  await page.locator('#width').press('Tab');
  await page.waitForFunction(() => !document.getElementById('problem').hidden);
  expect(/memory|pixels/.test(await text('problem')), `a size that is too large is refused: ${await text('problem')}`);
  await shot('refused');
  await page.waitForFunction(() => document.getElementById('width').value === '192');
  expect(true, 'and taken back');
}

async function changeLens() {
  const command = (part) => page.waitForFunction((wanted) => document.getElementById('command').value.includes(wanted), part, {timeout: 60000});
  await page.locator('#fov').fill('20');
  await page.locator('#fov').press('Tab');
  await command('--fov 20');
  expect(!await page.locator('#home').isDisabled(), 'As in the file takes the lens back, too');
  expect(await page.locator('#focus').isDisabled(), 'a pinhole has no focus');
  await page.locator('#aperture').selectOption('1.4');
  await command('--aperture 1.4');
  await page.waitForFunction(() => document.getElementById('focus-middle').getAttribute('aria-pressed') === 'true');
  const distance = Number(await page.locator('#focus').inputValue());
  expect(distance > 0, `the middle is sharp, at ${distance} m`);
  await page.locator('#focus-pick').click();
  const box = await page.locator('#picture').boundingBox(), eye = await text('eye');
  await page.mouse.click(box.x + 0.75 * box.width, box.y + 0.85 * box.height);
  await command('--focus ');
  await page.waitForFunction((old) => document.getElementById('focus').value !== old, String(distance));
  const picked = Number(await page.locator('#focus').inputValue());
  expect(picked > 0 && picked < distance, `the glass ball in front is sharp, at ${picked} m`);
  expect(await text('eye') === eye, 'picking moves no camera');
  expect(await page.locator('#focus-pick').getAttribute('aria-pressed') === 'false', 'one click is picked');
  await page.locator('#focus').fill('2.5');
  await page.locator('#focus').press('Tab');
  await command('--focus 2.5');
  await isRefined();
  await shot('lens');
  await page.locator('#aperture').selectOption('off');
  await command('--aperture off');
  await page.locator('#home').click();
  await page.waitForFunction(() => !/--(fov|aperture|focus)/.test(document.getElementById('command').value));
  expect(true, 'As in the file puts the lens back');
}

async function changeEnvironment() {
  const command = (part) => page.waitForFunction((wanted) => document.getElementById('command').value.includes(wanted), part, {timeout: 60000});
  const lights = () => page.locator('#light-list label').count(), before = await lights();
  const offered = await page.locator('#environment-source option').allTextContents();
  expect(offered.join() === 'As in the file,studio,overcast,sunny', `environments: ${offered.join()}`);
  expect(await page.locator('#environment-place').isHidden(), 'the file’s own environment does not turn');
  await page.locator('#environment-source').selectOption('sunny');
  await command('--environment sunny');
  await changes('the environment is among the lights', before, lights);
  await page.locator('#environment-rotation').fill('90');
  await command('--environment-rotate 90');
  await page.locator('#environment-scale').fill('1');
  await command('--environment-scale 2');
  expect(await text('environment-scale-text') === '× 2', 'its brightness is told');
  await isRefined();
  await page.locator('#environment').scrollIntoViewIfNeeded();
  await shot('environment');
  await page.locator('#environment-source').selectOption('');
  await page.waitForFunction(() => !document.getElementById('command').value.includes('--environment'));
  await page.waitForFunction((count) => document.querySelectorAll('#light-list label').length === count, before);
  expect(true, 'the file’s own environment comes back');
}

/// Noise of the canvas: the mean difference between neighbouring pixels.
const roughness = () => page.evaluate(() => {
  const canvas = document.getElementById('picture'), {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let sum = 0;
  for (let i = 4; i < data.length; i++) sum += Math.abs(data[i] - data[i - 4]);
  return sum / data.length;
});
async function denoisePicture() {
  await page.locator('#denoise').check();
  await page.waitForFunction(() => /^[0-9]+ passes, preview$/.test(document.getElementById('denoised').textContent), null, {timeout: 60000});
  await page.waitForFunction(() => document.getElementById('command').value.includes('--denoise'));
  const clean = await roughness();
  await shot('denoised');
  await page.locator('#denoise').uncheck();
  await page.waitForFunction(() => document.getElementById('denoised').hidden && !document.getElementById('command').value.includes('--denoise'));
  const noisy = await roughness();
  await shot('noisy');
  expect(clean < noisy, `Denoise makes the picture smoother: ${clean.toFixed(2)} instead of ${noisy.toFixed(2)}`);
}

async function lookAtNumbers() {
  await page.waitForFunction(() => !document.getElementById('left').hidden);
  expect(/^1:59:[0-5][0-9] h$/.test(await text('left')), `the time left is told: ${await text('left')}`);
  expect((await text('remark')).includes('caustics'), `what auto has found is told: ${await text('remark')}`);
  await page.locator('#remark').scrollIntoViewIfNeeded();
  await shot('numbers');
  await page.locator('aside').evaluate((panel) => { panel.scrollTop = 0; });
}

async function lookAtSmallScreen() {
  await page.setViewportSize({width: 1366, height: 768 - 140});  // less what a browser takes of the screen
  await page.locator('aside').evaluate((panel) => { panel.scrollTop = 0; });
  const lowest = await page.evaluate(() => Math.max(...['save-png', 'save-exr', 'copy', 'command'].map((id) => document.getElementById(id).getBoundingClientRect().bottom)));
  expect(lowest < 768 - 140, `what saves is seen on a small screen: down to ${lowest}`);
  await shot('small');
  await page.setViewportSize({width: 1280, height: 800});
}

async function download(button, first) {
  const [file] = await Promise.all([page.waitForEvent('download'), page.locator(button).click()]);
  const bytes = readFileSync(await file.path());
  expect(bytes.subarray(0, first.length).equals(Buffer.from(first)), `${file.suggestedFilename()} is saved, ${bytes.length} bytes`);
}

async function lookElsewhere() {
  await page.emulateMedia({colorScheme: 'light'});
  await shot('light');
  await page.setViewportSize({width: 390, height: 780});
  await page.waitForTimeout(300);
  expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'a narrow window needs no sideways scrolling');
  await shot('narrow');
  await page.setViewportSize({width: 1280, height: 800});
  await page.emulateMedia({colorScheme: 'dark'});
  await page.locator('#help').click();
  await shot('help');
  await page.keyboard.press('Escape');
  const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, select, textarea, canvas')].filter((e) =>
      !(e.labels?.length || e.getAttribute('aria-label') || e.textContent.trim())).length);
  expect(nameless === 0, 'every control has a name');
}

try {
  await page.goto(address);
  await isRefined();
  await page.waitForTimeout(1500);
  await shot('first');
  expect(sum(await mean()) > 30, 'there is a picture');
  await lookAtNumbers();
  await denoisePicture();
  await drag();
  await steerByKeys();
  await useControls();
  expect(await page.locator('#light-list label').first().textContent() === 'Lamp, ceiling area1', 'the lamp has a name');
  await editOnSlowLine();
  await readPixels();
  await changeLens();
  await changeEnvironment();
  await changeMethodAndSize();
  await lookAtSmallScreen();
  await page.locator('#pause').click();
  await page.waitForFunction(() => document.getElementById('state').dataset.state === 'paused');
  await isRefined();
  await download('#save-png', [0x89, 0x50, 0x4e, 0x47]);
  await download('#save-exr', [0x76, 0x2f, 0x31, 0x01]);
  await lookElsewhere();
  expect(requests.every((url) => url.startsWith(address) || url.startsWith('data:') || url.startsWith('blob:')), 'nothing is loaded from elsewhere');
  hasEnded = true;
  server.kill('SIGINT');
  await page.waitForFunction(() => document.getElementById('state').dataset.state === 'lost');
  expect(true, 'the page says that the server has gone');
} catch (problem) {
  await shot('failed');
  expect(false, problem.message);
} finally {
  server.kill('SIGKILL');
  await context.close();
  rmSync(folder, {recursive: true});
}
process.exit(failures === 0 ? 0 : 1);
