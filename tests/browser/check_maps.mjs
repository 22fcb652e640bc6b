// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Usage: node check_maps.mjs LANTHORN [SCREENSHOT-FOLDER]
// Bakes environments and has three.js and Filament light balls with the files in headless Chromium. Exit code 77 if the packages
// or the browser are missing: the test is skipped.
import {execFileSync} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {dirname, extname, join, normalize} from 'node:path';
import {fileURLToPath} from 'node:url';
import {across, balls, ballsAsGlb, normalAt, places} from './balls.mjs';
import {colours, irradianceOfOrder2, pfm, shade, skyOfAxes, uniformSky} from './sky.mjs';

const here = dirname(fileURLToPath(import.meta.url)), [program, screenshots] = process.argv.slice(2);
const skip = (why) => {
  console.log(`SKIPPED: ${why}`);
  process.exit(77);
};
const browserPath = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync);
if (!browserPath) skip('no chromium (scripts/install-packages browser)');
const playwright = await import('playwright-core').catch(() => skip('no playwright-core (npm ci in tests/browser)'));

// `sky` has a sun of 1e5 in one texel. That of `soft` is weak enough for Filament's 8-bit pictures to show its surroundings.
const sky = skyOfAxes(1e5), soft = skyOfAxes(3e3), white = uniformSky([1, 1, 1]);
const folder = mkdtempSync(join(tmpdir(), 'lanthorn-maps-'));
function bake(name, environment, ...options) {
  writeFileSync(join(folder, `${name}.pfm`), pfm(environment));
  execFileSync(program, ['ibl', `${name}.pfm`, '-o', name, '-q', '--size', '256', '--smallest', '16', '--samples', '1024', '--check', '0', ...options],
               {cwd: folder, stdio: 'pipe'});
}
bake('sky', sky, '--mapping', 'filament', '--formats', 'exr,ktx2');
bake('square', sky, '--formats', 'ktx2');
bake('soft', soft, '--mapping', 'filament', '--formats', 'ktx2');
bake('white', white, '--mapping', 'filament', '--formats', 'ktx2');
writeFileSync(join(folder, 'balls.glb'), ballsAsGlb());
const page = readFileSync(join(here, '../../docs/methods/ibl.md'), 'utf8');
const snippet = page.match(/( {4}vec2 ab = .*\n)( {4}.*\n)+/)[0];

const types = {'.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm'};
const server = createServer((request, response) => {
  const path = normalize(new URL(request.url, 'http://localhost').pathname);
  const file = [folder, here].map((root) => join(root, path)).find(existsSync);
  if (!file) return response.writeHead(404).end();
  response.writeHead(200, {'Content-Type': types[extname(file)] ?? 'application/octet-stream'}).end(readFileSync(file));
});
await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));

const browser = await playwright.chromium.launch({executablePath: browserPath, args: [
  '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']});
let failures = 0;
const expect = (good, text) => {
  console.log(`${good ? 'ok' : 'FAILED'}: ${text}`);
  if (!good) failures++;
};

async function runPage(name, request) {
  const page = await browser.newPage();
  page.on('pageerror', (e) => expect(false, `${name}: ${e.message}`));
  page.on('console', (m) => m.type() === 'error' && console.log(`${name}: ${m.text()}`));
  await page.goto(`http://127.0.0.1:${server.address().port}/${name}.html`);
  await page.waitForFunction('window.ready');
  const result = await page.evaluate((r) => window.run(r), request);
  if (screenshots) await page.locator('canvas').screenshot({path: join(screenshots, `${name}.png`)});
  await page.close();
  return result;
}

// Compares pixels of a ball with the truth. Tolerances: `share` of the truth plus `rounding` of the ball's brightest value.
function expectNear(name, found, truth, share, rounding = 0) {
  const brightest = Math.max(...truth.flat());
  const worst = Math.max(...truth.flat().map((t, i) => Math.abs(found.flat()[i] - t) / (share * t + rounding * brightest)));
  expect(worst <= 1, `${name}: within ${worst.toFixed(2)} of the limit (${(100 * share).toFixed(1)} %)`);
}
const truthOf = (engine, environment) => balls.map((ball) => places.map((place) => shade(engine, environment, ball, normalAt(place), 2 / across)));

async function checkThree() {
  const three = await runPage('three', {balls, places, across, snippet});
  expect(three.error === 0, 'three.js: no WebGL error');
  expect(three.levels.length === 5, `three.js: ${three.levels.length} levels`);
  three.levels.forEach(({worst, largest}, i) =>
      expect(worst <= 1.001 && largest > 0.5, `three.js: level ${i} within ${worst.toFixed(3)} roundings of the EXR file (largest ${largest})`));
  expect(three.irradiance.worst <= 1.001, `three.js: irradiance within ${three.irradiance.worst.toFixed(3)} roundings`);
  const truth = truthOf('three', sky), splitSum = truthOf('split sum', sky);
  balls.forEach(({name, color}, i) => {
    if (Math.min(...color) === 1) expectNear(`three.js: ${name} in a white furnace`, three.white[i], places.map(() => color), 0.002);
    expectNear(`three.js: ${name} under the sky`, three.sky[i], truth[i], 0.02);
    expectNear(`the lines of docs/methods/ibl.md: ${name}`, three.splitSum[i], splitSum[i], 0.02);
  });
  expectNear('three.js: plaster under the light probe', three.probe, places.map((place) => irradianceOfOrder2(sky, normalAt(place))), 0.01);
}

async function checkFilament() {
  // Pixel values of radiance 1, chosen so that the brightest pixel of a ball is not clipped.
  const truth = truthOf('filament', soft), ofSky = 0.45, ofFurnace = 0.8, ofBalls = truth.map((ball) => 0.95 / Math.max(...ball.flat()));
  const filament = await runPage('filament', {balls, places, ofSky, intensities: {white: balls.map(() => ofFurnace), soft: ofBalls}});
  filament.colours.forEach((seen, i) => expect(colours[i].every((c, k) => Math.abs(seen[k] / 255 - ofSky * c) < 1 / 255), `Filament: sky along axis ${i} is ${seen}`));
  const radiance = (pixels, intensity) => pixels.flat().map((x) => x / 255 / intensity);
  balls.forEach(({name, color}, i) => {
    if (Math.min(...color) === 1) expectNear(`Filament: ${name} in a white furnace`, radiance(filament.white[i], ofFurnace), places.map(() => color), 0.005, 1 / 255);
    expectNear(`Filament: ${name} under the sky`, radiance(filament.soft[i], ofBalls[i]), truth[i], 0.02, 1 / 255);
  });
}

try {
  await checkThree();
  await checkFilament();
} finally {
  await browser.close();
  server.close();
  rmSync(folder, {recursive: true});
}
process.exit(failures === 0 ? 0 : 1);
