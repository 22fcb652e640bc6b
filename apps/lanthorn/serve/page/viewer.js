// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
'use strict';
const byId = (id) => document.getElementById(id);
const make = (tag, properties) => Object.assign(document.createElement(tag), properties);
const canvas = byId('picture'), stage = byId('stage'), context = canvas.getContext('2d', {alpha: false});

// State of the display: the last frame {about, halves}, how it is shown, and the camera as this page moves it.
let frame = null, layer = 'color', display = {exposure: 0, curve: 'none', auto: false}, camera = null, upward = null;
let lights = {}, moving = false, frameTimes = [];

// Numbers

/// Every half float as a number (IEEE 754 binary16).
const numbers = new Float32Array(65536);
for (let bits = 0; bits < 65536; bits++) {
  const exponent = bits >> 10 & 31, fraction = bits & 1023, sign = bits & 0x8000 ? -1 : 1;
  numbers[bits] = sign * (exponent === 0 ? fraction * 2 ** -24 : exponent === 31 ? (fraction ? NaN : Infinity) : (1 + fraction / 1024) * 2 ** (exponent - 15));
}

const add = (a, b) => a.map((x, i) => x + b[i]);
const sub = (a, b) => a.map((x, i) => x - b[i]);
const scale = (a, s) => a.map((x) => x * s);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const unit = (a) => scale(a, 1 / length(a));
/// Rotation by Rodrigues' formula.
function rotate(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1 - c)));
}

// Display

/// The strength of the curve `highlights`, as in src/film/display.h: `white` becomes 1. 0: the curve is a straight line.
const knee = 0.7;
function highlightStrength(white) {
  const span = Math.min(white, 65536) - knee, left = 1 - knee;
  if (!(white > 1.0001)) return 0;
  let a = 100;
  for (let i = 0; i < 64; i++) a -= (left * a - Math.log1p(a * span)) / (left - span / (1 + a * span));
  return a;
}
/// The value that a thousandth of the pixels' brightest components exceed.
function brightestOf(halves, count) {
  const step = count * Math.max(1, Math.floor(halves.length / count / 20000)), values = [];
  for (let i = 0; i + count <= halves.length; i += step) values.push(Math.max(...Array.from({length: count}, (_, c) => numbers[halves[i + c]])));
  values.sort((a, b) => a - b);
  return values[Math.floor(0.999 * (values.length - 1))] ?? 0;
}

/// Converts a linear value to a display value from 0 to 255, as `lanthorn render --exposure E --view-transform
/// none|filmic|highlights` does.
function displayed(value, gain, filmic, strength) {
  let x = Math.min(value * gain, 65536);
  if (!(x > 0)) return 0;
  if (filmic) x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  if (strength > 0 && x > knee) x = knee + Math.log1p(strength * (x - knee)) / strength;
  x = Math.min(x, 1);
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
}

let table = new Uint8Array(65536), tableKey = '';
/// `range`: for layers of one channel, else null. Pixels without a surface (0) are black.
function makeTable(exposure, filmic, strength, isVector, range) {
  const key = `${exposure} ${filmic} ${strength} ${isVector} ${range?.black} ${range?.white}`;
  if (key === tableKey) return;
  tableKey = key;
  const gain = 2 ** exposure;
  const shown = isVector ? (x) => 0.5 + 0.5 * x : range ? (x) => x > 0 ? (x - range.black) / (range.white - range.black) : 0 : (x) => x;
  for (let bits = 0; bits < 65536; bits++) table[bits] = displayed(shown(numbers[bits]), gain, filmic, strength);
}

/// AgX, as in src/film/display.h: the sigmoid at 4096 points from 10 stops below middle grey to 6.5 above.
const agxSigmoid = Float32Array.from({length: 4096}, (_, i) => {
  const x = i / 4095, pivot = 10 / 16.5, power = x < pivot ? 3 : 3.25, end = 2 * (x < pivot ? pivot : 1 - pivot);
  const size = (((2 * end) ** power - 1) * end ** -power) ** (-1 / power), t = 2 * Math.abs(x - pivot) / size;
  const y = size * t / (1 + t ** power) ** (1 / power);
  return x < pivot ? 0.5 - y : 0.5 + y;
});
const agxCurve = (x) => agxSigmoid[Math.round(4095 * Math.min(1, Math.max(0, (Math.log2(x / 0.18) + 10) / 16.5)))];
const agxWhite = (r, g, b) => 0.2 * (0.2120 * r + 0.3921 * g + 0.3959 * b);
function drawAgx(pixels, halves, count, gain) {
  const linear = (half) => Math.min(Math.max(numbers[half] * gain, 0), 1e4) || 0;
  const green = Math.min(1, count - 1), blue = Math.min(2, count - 1);
  for (let from = 0, to = 0; to < pixels.length; from += count, to += 4) {
    let r = linear(halves[from]), g = linear(halves[from + green]), b = linear(halves[from + blue]);
    const white = agxWhite(r, g, b);
    r = agxCurve(0.8 * r + white);
    g = agxCurve(0.8 * g + white);
    b = agxCurve(0.8 * b + white);
    const inside = agxWhite(r, g, b);  // the array clamps
    pixels[to] = 255 * (r - inside) / 0.8;
    pixels[to + 1] = 255 * (g - inside) / 0.8;
    pixels[to + 2] = 255 * (b - inside) / 0.8;
    pixels[to + 3] = 255;
  }
}

/// Normals get no curve, and layers of one channel have no colours that AgX could change, and no highlights.
function curveOfFrame() {
  if (frame.about.layer === 'normal') return 'none';
  return display.curve !== 'filmic' && frame.range ? 'none' : display.curve;
}

/// The values of a one-channel layer that are shown black and white: 0 and the largest value. For depth: far and near,
/// chosen so that 98 % of the visible surfaces lie in between.
function rangeOf(about, halves) {
  if (about.channels.length > 1) return null;
  const step = Math.max(1, Math.floor(halves.length / 20000)), values = [];
  for (let i = 0; i < halves.length; i += step) if (numbers[halves[i]] > 0) values.push(numbers[halves[i]]);
  values.sort((a, b) => a - b);
  if (values.length === 0) return {black: 0, white: 1};
  const at = (share) => values[Math.round(share * (values.length - 1))];
  const near = at(0.01), far = at(0.99);
  return about.layer === 'depth' && far > near ? {black: far, white: near} : {black: 0, white: values.at(-1)};
}
function showRange() {
  const isDepth = frame.range && frame.about.layer === 'depth', metres = (x) => `${Number(x.toPrecision(3))} m`;
  byId('range').hidden = !isDepth;
  if (isDepth) byId('range').textContent = `White: ${metres(frame.range.white)}; black: ${metres(frame.range.black)} and farther`;
}

function draw() {
  if (!frame) return;
  const {width, height, channels} = frame.about, count = channels.length, isVector = frame.about.layer === 'normal';
  const curve = curveOfFrame();
  const strength = curve === 'highlights' ? highlightStrength(frame.brightest * 2 ** display.exposure) : 0;
  makeTable(display.exposure, curve === 'filmic', strength, isVector, frame.range);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  const image = context.createImageData(width, height), pixels = image.data, halves = frame.halves;
  const green = Math.min(1, count - 1), blue = Math.min(2, count - 1);
  if (curve === 'agx') drawAgx(pixels, halves, count, 2 ** display.exposure);
  else for (let from = 0, to = 0; to < pixels.length; from += count, to += 4) {
    pixels[to] = table[halves[from]];
    pixels[to + 1] = table[halves[from + green]];
    pixels[to + 2] = table[halves[from + blue]];
    pixels[to + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  fit();
}

/// Scales the canvas to the stage; coarse pictures are shown as large as fine ones.
function fit() {
  if (!frame) return;
  const style = getComputedStyle(stage), padding = parseFloat(style.paddingLeft) * 2;
  const ratio = frame.about.full_size[0] / frame.about.full_size[1], width = Math.min(stage.clientWidth - padding, (stage.clientHeight - padding) * ratio);
  canvas.style.width = `${Math.max(1, Math.floor(width))}px`;
  canvas.style.height = `${Math.max(1, Math.floor(width / ratio))}px`;
  canvas.style.imageRendering = !frame.about.coarse && width > 3 * frame.about.width ? 'pixelated' : 'auto';
}
new ResizeObserver(fit).observe(stage);

// Frames

const wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
let request = null;

function decode(buffer) {
  const size = new DataView(buffer).getUint32(0, true), about = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
  const start = 4 + size, count = about.width * about.height * about.channels.length;
  const halves = new Uint16Array(buffer, start, count);
  return {about, halves, range: rangeOf(about, halves), brightest: brightestOf(halves, about.channels.length)};
}

async function nextFrame() {
  request = new AbortController();
  const after = frame && frame.about.layer === layer && (!display.auto || 'measured_exposure' in frame.about) ? frame.about.number : 0;
  const response = await fetch(`frame?after=${after}&layer=${encodeURIComponent(layer)}&measure=${display.auto ? 1 : 0}`, {signal: request.signal});
  if (response.status === 204) return null;
  if (!response.ok) throw new Error(response.statusText);
  return decode(await response.arrayBuffer());
}

async function watch() {
  for (;;) {
    try {
      const next = await nextFrame();
      if (next) receive(next);
      lost(false);
    } catch (problem) {
      if (problem.name === 'AbortError') continue;
      lost(true);
      await wait(1000);
    }
  }
}

function receive(next) {
  frame = next;
  const {about} = frame;
  frameTimes = [...frameTimes, performance.now()].slice(-20);
  if (display.auto && 'measured_exposure' in about) setExposure(about.measured_exposure);
  takeChanges(about);
  draw();
  readOut();
  showRange();
  showLayers(about.layers);
  showProgress(about);
}

/// Adopts edits that other pages have made. A picture from before this page's last edit contains nothing new.
function takeChanges(about) {
  if (isSending || about.revision < knownRevision) return;
  camera = about.camera;
  const take = (input, value) => { if (document.activeElement !== input || !input.dataset.typed) input.value = value; };
  take(byId('method'), about.integrator);
  take(byId('width'), about.full_size[0]);
  take(byId('height'), about.full_size[1]);
  takeLens(about.lens, take);
  takeEnvironment(about.environment);
  if (!upward) upward = nearestAxis(camera.up);
  for (const [name, {slider, show}] of Object.entries(sliders)) {
    const factor = about.lights[name] ?? 1;
    lights[name] = factor;
    slider.value = stopsOf(factor);
    show(factor);
  }
}

const shortened = (x) => x === null ? '' : Number(x.toPrecision(4));
function takeLens({fov, aperture, focus, focuses_middle}, take) {
  byId('fov').disabled = byId('aperture').disabled = fov === null;
  for (const id of ['focus', 'focus-middle', 'focus-pick']) byId(id).disabled = focus === null;
  take(byId('fov'), shortened(fov));
  take(byId('focus'), shortened(focus));
  const name = aperture === null ? 'off' : `${shortened(aperture)}`, select = byId('aperture');
  if (![...select.options].some((option) => option.value === name)) select.append(new Option(`f/${name}`, name));
  select.value = name;
  byId('focus-middle').setAttribute('aria-pressed', focus !== null && focuses_middle);
  if (focus === null) pick(false);
}
function takeEnvironment({source, rotation, scale}) {
  if (listedSource !== null && listedSource !== source) listLights();
  listedSource = source;
  environment = {source, rotation, scale};
  byId('environment-source').disabled = false;
  byId('environment-source').value = source;
  byId('environment-place').hidden = source === '';
  byId('environment-rotation').value = rotation;
  byId('environment-scale').value = stopsOf(scale);
  showEnvironment();
}
function showEnvironment() {
  const {rotation, scale} = environment;
  byId('environment-rotation-text').textContent = `${Number(rotation.toPrecision(4))}°`;
  byId('environment-scale-text').textContent = factorText(scale);
  byId('environment-scale').setAttribute('aria-valuetext', factorText(scale));
}

const nearestAxis = (v) => {
  const axis = [0, 1, 2].reduce((a, b) => Math.abs(v[b]) > Math.abs(v[a]) ? b : a);
  return [0, 1, 2].map((i) => i === axis ? Math.sign(v[axis]) : 0);
};

// Text

const grouped = (n) => n >= 1e9 ? `${(n / 1e9).toFixed(2)} G` : n >= 1e6 ? `${(n / 1e6).toFixed(2)} M` : n >= 1e4 ? `${(n / 1e3).toFixed(1)} k` : `${n}`;
const two = (x) => String(Math.floor(x)).padStart(2, '0');
const time = (s) => s < 60 ? `${s.toFixed(1)} s` : s < 3600 ? `${Math.floor(s / 60)}:${two(s % 60)} min` : `${Math.floor(s / 3600)}:${two(s / 60 % 60)}:${two(s % 60)} h`;
const place = (v) => v.map((x) => Number(x.toPrecision(3))).join(', ');

function showState(state, text) {
  byId('state').dataset.state = state;
  byId('state-text').textContent = text;
}
let isLost = false;
function lost(now) {
  if (now) showState('lost', 'The server does not answer');
  if (now !== isLost) say(now ? 'The server does not answer' : 'The server answers again');
  if (!now && isLost && frame) showProgress(frame.about);
  isLost = now;
}
function say(text) {
  byId('live').textContent = text;
}

function showLayers(names) {
  const select = byId('layer');
  if (names.join() === [...select.options].map((o) => o.value).join()) return;
  select.replaceChildren(...names.map((name) => new Option(name, name, false, name === layer)));
}

function showProgress(about) {
  const passes = `${about.passes} ${about.passes === 1 ? 'pass' : 'passes'}`;
  if (about.problem) showState('failed', about.problem);
  else if (about.coarse) showState('rendering', 'Coarse picture');
  else if (about.finished) showState('finished', `Finished: ${passes}, ${time(about.seconds)}`);
  else if (about.paused) showState('paused', `Paused after ${passes}`);
  else showState('rendering', `${passes}, ${time(about.seconds)}`);
  byId('problem').hidden = !about.problem;
  if (byId('problem').textContent !== about.problem) byId('problem').textContent = about.problem;
  byId('pause').textContent = about.paused ? 'Resume' : 'Pause';
  byId('pause').disabled = about.finished;
  for (const id of ['method', 'width', 'height']) byId(id).disabled = false;
  for (const id of ['limitation', 'remark']) {
    byId(id).hidden = !about[id];
    byId(id).textContent = about[id];
  }
  byId('passes').textContent = about.coarse ? 'coarse' : about.passes;
  byId('time').textContent = time(about.seconds);
  byId('left').hidden = byId('left-term').hidden = !(about.seconds_left > 0);
  byId('left').textContent = time(about.seconds_left ?? 0);
  byId('error').textContent = about.error || '–';
  if (!isSending) byId('denoise').checked = about.denoise;
  byId('denoised').hidden = byId('denoised-term').hidden = !about.denoised;
  if (about.denoised) byId('denoised').textContent = `${about.denoised.passes} passes${about.denoised.preview ? ', preview' : ''}`;
  byId('samples').textContent = grouped(about.samples);
  for (const id of ['photons', 'photons-term']) byId(id).hidden = !about.traces_photons;
  byId('photons').textContent = grouped(about.photons);
  for (const [id, radius] of [['radius', about.radius], ['volume-radius', about.volume_radius]]) {
    byId(id).hidden = byId(`${id}-term`).hidden = !(radius > 0);
    byId(id).textContent = `${Number(radius.toPrecision(3))} m`;
  }
  const span = frameTimes.at(-1) - frameTimes[0];
  byId('rate').textContent = frameTimes.length > 1 && span > 0 ? `${((frameTimes.length - 1) * 1000 / span).toFixed(1)} pictures/s` : '–';
  byId('eye').textContent = place(about.camera.eye);
  byId('target').textContent = place(about.camera.target);
  byId('home').disabled = !about.moved;
  byId('lights-reset').hidden = !Object.values(about.lights).some((factor) => factor !== 1);
  for (const id of ['save-png', 'save-exr', 'copy']) byId(id).disabled = about.coarse;
  if (!about.coarse && byId('command').value !== about.command) byId('command').value = about.command;
  canvas.setAttribute('aria-label', `${byId('title').textContent}: layer ${about.layer}, ${about.coarse ? 'coarse' : passes}`);
}

// Edits: one request at a time; edits made meanwhile are combined into the next.

let pending = null, isSending = false, knownRevision = 0;
async function edit(change) {
  const lens = 'lens' in change ? change.lens && {...pending?.lens, ...change.lens} : pending?.lens;
  pending = {...pending, ...change, lens};
  if (isSending) return;
  isSending = true;
  while (pending) {
    const body = JSON.stringify(pending);
    pending = null;
    try {
      const response = await fetch('edit', {method: 'POST', headers: {'Content-Type': 'application/json'}, body});
      if (response.ok) knownRevision = (await response.json()).revision;
      else if (response.status === 400) showState('failed', await response.text());
    } catch {
      lost(true);
    }
  }
  isSending = false;
  if (frame) takeChanges(frame.about);
}

let restTimer = 0;
/// Sends the camera; `moving` stays set until no edit has followed for a moment.
function moveCamera(next, goesOn) {
  camera = next;
  moving = true;
  clearTimeout(restTimer);
  edit({camera: {eye: camera.eye, target: camera.target, up: camera.up}, moving: true, home: undefined});
  if (!goesOn) restTimer = setTimeout(rest, 180);
}
function rest() {
  clearTimeout(restTimer);
  moving = false;
  edit({moving: false});
}

// Camera: left-handed axes as the server has them, or mirrored.

function axes() {
  const forward = unit(sub(camera.target, camera.eye)), right = scale(unit(cross(camera.up, forward)), camera.mirrored ? -1 : 1);
  return {forward, right, up: unit(sub(camera.up, scale(forward, dot(camera.up, forward))))};
}

/// Orbits around the target by `x` and `y`, in radians, so that the scene follows the pointer.
function turn(x, y) {
  if (!camera) return null;
  const {right, up} = axes(), from = sub(camera.eye, camera.target), least = 0.02;
  const yaw = -x * (Math.sign(dot(cross(upward, from), right)) || 1), pitch = y * (Math.sign(dot(cross(right, from), up)) || 1);
  const tilted = rotate(from, right, pitch), cosine = dot(unit(tilted), upward);
  const isSteep = Math.abs(cosine) > Math.cos(least) && Math.abs(cosine) > Math.abs(dot(unit(from), upward));
  const both = (v) => rotate(isSteep ? v : rotate(v, right, pitch), upward, yaw);
  return {...camera, eye: add(camera.target, both(from)), up: both(up)};
}
/// Moves the camera sideways by pixels of the screen.
function shift(x, y) {
  if (!camera) return null;
  const {right, up} = axes(), distance = length(sub(camera.target, camera.eye));
  const perPixel = 2 * distance * Math.tan((frame.about.lens.fov ?? 40) * Math.PI / 360) / Math.min(canvas.clientWidth, canvas.clientHeight);
  const by = add(scale(right, -x * perPixel), scale(up, y * perPixel));
  return {...camera, eye: add(camera.eye, by), target: add(camera.target, by)};
}
function approach(factor) {
  if (!camera) return null;
  return {...camera, eye: add(camera.target, scale(sub(camera.eye, camera.target), factor))};
}
const steer = (next, goesOn = false) => next && moveCamera(next, goesOn);
const home = () => edit({home: true, camera: undefined, lens: undefined, lights: undefined, moving: false});

// Pointers

const pointers = new Map(), radiansPerPixel = 0.0065;
let pointer = null;  // position over the picture, in the window
const middle = () => scale([...pointers.values()].reduce(add), 1 / pointers.size);
const spread = () => pointers.size < 2 ? 0 : length(sub(...pointers.values()));

canvas.addEventListener('pointerdown', (event) => {
  if (isPicking) return focusAt(event);
  canvas.setPointerCapture(event.pointerId);
  canvas.focus({preventScroll: true});
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
});
canvas.addEventListener('pointermove', (event) => {
  pointer = [event.clientX, event.clientY];
  readOut();
  if (!pointers.has(event.pointerId)) return;
  const before = middle(), wide = spread();
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  const [x, y] = sub(middle(), before);
  if (x === 0 && y === 0 && wide === spread()) return;
  const slides = event.shiftKey || event.buttons === 2 || event.buttons === 4 || pointers.size > 1;
  steer(slides ? shift(x, y) : turn(x * radiansPerPixel, y * radiansPerPixel), true);
  if (wide > 0) steer(approach(wide / Math.max(1, spread())), true);
});
function release(event) {
  if (pointers.delete(event.pointerId) && pointers.size === 0 && moving) rest();
}
canvas.addEventListener('pointerup', release);
canvas.addEventListener('pointercancel', release);
canvas.addEventListener('pointerleave', () => {
  pointer = null;
  readOut();
});
canvas.addEventListener('contextmenu', (event) => event.preventDefault());
canvas.addEventListener('dblclick', () => Date.now() - pickedAt > 500 && home());
canvas.addEventListener('wheel', (event) => {
  event.preventDefault();
  const lines = event.deltaMode === 1 ? 16 : 1;
  steer(approach(Math.exp(Math.max(-240, Math.min(240, event.deltaY * lines)) * 0.0016)));
}, {passive: false});

/// Shows the linear values under the pointer in the current picture. Positions are pixels of the full picture.
function readOut() {
  const box = canvas.getBoundingClientRect();
  const share = pointer && frame && box.width > 0 ? [(pointer[0] - box.left) / box.width, (pointer[1] - box.top) / box.height] : [-1, -1];
  const isInside = share.every((s) => s >= 0 && s < 1);
  byId('readout').hidden = !isInside;
  if (!isInside) return;
  const {width, height, channels, full_size: full} = frame.about;
  const at = (Math.floor(share[1] * height) * width + Math.floor(share[0] * width)) * channels.length;
  const values = channels.map((_, i) => numbers[frame.halves[at + i]].toPrecision(4));
  const unit = frame.about.layer === 'depth' ? ' m' : '';
  byId('readout').textContent = `${Math.floor(share[0] * full[0])}, ${Math.floor(share[1] * full[1])}   ${values.join('  ')}${unit}`;
}

// Keys

const steps = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
canvas.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const step = steps[event.key];
  if (step) steer(event.shiftKey ? shift(24 * step[0], 24 * step[1]) : turn(0.09 * step[0], 0.09 * step[1]));
  else if (event.key === '+' || event.key === '=') steer(approach(0.9));
  else if (event.key === '-') steer(approach(1 / 0.9));
  else if (event.key === 'Home') home();
  else if (event.key === 'Escape' && isPicking) pick(false);
  else if (event.key === '[' || event.key === ']') chooseExposure(display.exposure + (event.key === ']' ? 0.5 : -0.5));
  else if (event.key === 'l' || event.key === 'L') nextLayer();
  else if (event.key === ' ') byId('pause').click();
  else if (event.key === '?') byId('help').click();
  else return;
  event.preventDefault();
});

// Controls

function setExposure(stops) {
  display.exposure = Math.max(-64, Math.min(64, Math.round(10 * stops) / 10));
  byId('exposure').value = display.exposure;
  byId('exposure-text').textContent = `${display.exposure > 0 ? '+' : ''}${display.exposure.toFixed(1)} stops`;
  byId('exposure').setAttribute('aria-valuetext', `${display.exposure.toFixed(1)} stops`);
}
function chooseExposure(stops) {
  display.auto = byId('auto').checked = false;
  setExposure(stops);
  draw();
}
function chooseLayer(name) {
  layer = name;
  byId('layer').value = name;
  say(`Layer ${name}`);
  request?.abort();
}
function nextLayer() {
  const names = [...byId('layer').options].map((o) => o.value);
  chooseLayer(names[(names.indexOf(layer) + 1) % names.length]);
}
byId('exposure').addEventListener('input', (event) => chooseExposure(Number(event.target.value)));
byId('auto').addEventListener('change', (event) => {
  display.auto = event.target.checked;
  request?.abort();
});
byId('curve').addEventListener('change', (event) => {
  display.curve = event.target.value;
  draw();
});
byId('denoise').addEventListener('change', (event) => edit({denoise: event.target.checked}));
byId('layer').addEventListener('change', (event) => chooseLayer(event.target.value));
byId('nearer').addEventListener('click', () => steer(approach(0.8)));
byId('farther').addEventListener('click', () => steer(approach(1.25)));
byId('home').addEventListener('click', home);
byId('pause').addEventListener('click', () => frame && edit({paused: !frame.about.paused}));
byId('help').addEventListener('click', () => byId('help-dialog').showModal());
byId('command').addEventListener('focus', (event) => event.target.select());
byId('copy').addEventListener('click', async () => {
  try {
    await navigator.clipboard.writeText(byId('command').value);
  } catch {  // browsers allow the clipboard only on this machine or with encryption
    byId('command').select();
    document.execCommand('copy');
  }
  say('Copied');
  byId('copy').textContent = 'Copied';
  setTimeout(() => { byId('copy').textContent = 'Copy command'; }, 1500);
});

async function save(button, address) {
  button.disabled = true;
  try {
    const response = await fetch(address);
    if (!response.ok) throw new Error(response.statusText);
    const link = make('a', {href: URL.createObjectURL(await response.blob())});
    link.download = /filename="([^"]+)"/.exec(response.headers.get('Content-Disposition'))?.[1] ?? 'picture';
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    say(`Saved ${link.download}`);
  } catch (problem) {
    showState('failed', `Not saved: ${problem.message}`);
  }
  button.disabled = frame.about.coarse;
}
byId('save-png').addEventListener('click', (event) => {
  const range = frame.range ? `&black=${frame.range.black}&white=${frame.range.white}` : '';
  save(event.target, `picture.png?exposure=${display.exposure}&curve=${curveOfFrame()}&layer=${encodeURIComponent(layer)}${range}`);
});
byId('save-exr').addEventListener('click', (event) => save(event.target, 'picture.exr'));

// Lens

let isPicking = false, pickedAt = 0;
function pick(now) {
  isPicking = now;
  canvas.classList.toggle('picking', now);
  byId('focus-pick').setAttribute('aria-pressed', now);
  if (!now) return;
  canvas.focus({preventScroll: true});
  say('Click a point in the picture to focus on it');
}
function focusAt(event) {
  const box = canvas.getBoundingClientRect(), full = frame.about.full_size;
  const share = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  event.preventDefault();
  pickedAt = Date.now();
  pick(false);
  edit({lens: {focus_at: share.map((s, i) => s * full[i])}});
}
/// Numbers are sent when they are complete.
function onNumber(id, change) {
  byId(id).addEventListener('input', (event) => { event.target.dataset.typed = '1'; });
  byId(id).addEventListener('change', (event) => {
    delete event.target.dataset.typed;
    if (event.target.value !== '') change(Number(event.target.value));
  });
}
/// Sends the camera's position along with the field of view: a camera that frames its subject would move with it.
onNumber('fov', (fov) => {
  const {eye, target, up} = camera;
  edit({lens: {fov}, ...frame.about.lens.frames_subject && {camera: {eye, target, up}}});
});
onNumber('focus', (focus) => edit({lens: {focus, focus_at: undefined}}));
byId('aperture').replaceChildren(new Option('Off: everything is sharp', 'off'),
    ...[1.4, 2, 2.8, 4, 5.6, 8, 11, 16, 22, 32].map((f) => new Option(`f/${f}`, `${f}`)));
byId('aperture').addEventListener('change', ({target: {value}}) => edit({lens: {aperture: value === 'off' ? value : Number(value)}}));
byId('focus-middle').addEventListener('click', () => edit({lens: {focus: 'auto', focus_at: undefined}}));
byId('focus-pick').addEventListener('click', () => pick(!isPicking));

// Environment

let environment = null, listedSource = null;  // source whose lights are listed
function changeEnvironment(change, isMoving) {
  if (!environment) return;
  environment = {...environment, ...change};
  showEnvironment();
  edit({environment, moving: isMoving});
}
byId('environment-source').addEventListener('change', (event) => changeEnvironment({source: event.target.value, rotation: 0, scale: 1}, false));
for (const [event, isMoving] of [['input', true], ['change', false]]) {
  byId('environment-rotation').addEventListener(event, ({target}) => changeEnvironment({rotation: Number(target.value)}, isMoving));
  byId('environment-scale').addEventListener(event, ({target}) => changeEnvironment({scale: factorOf(Number(target.value))}, isMoving));
}

// Lights: sliders in stops; the lowest position is off.

const darkest = -6;
let sliders = {};
const stopsOf = (factor) => factor > 0 ? Math.max(darkest + 0.1, Math.log2(factor)) : darkest;
const factorText = (factor) => factor === 0 ? 'off' : `× ${Number(factor.toPrecision(3))}`;
const factorOf = (stops) => stops <= darkest ? 0 : Number((2 ** stops).toPrecision(4));

function lightRow({name, description}) {
  const row = make('div', {className: 'light'}), head = make('div', {className: 'row'}), shown = make('output');
  const slider = make('input', {id: `light-${name}`, type: 'range', min: darkest, max: 4, step: 0.1, value: 0});
  const label = make('label', {className: 'name', htmlFor: slider.id});
  shown.htmlFor.add(slider.id);
  label.append(`${description} `, make('small', {textContent: name}));
  const show = (factor) => {
    shown.textContent = factorText(factor);
    slider.setAttribute('aria-valuetext', factor === 0 ? 'off' : `${Number(factor.toPrecision(3))} times`);
  };
  const change = (isMoving) => {
    lights[name] = factorOf(Number(slider.value));
    if (Math.abs(slider.value) < 0.05) lights[name] = 1;
    show(lights[name]);
    edit({lights: {...lights}, moving: isMoving});
  };
  slider.addEventListener('input', () => change(true));
  slider.addEventListener('change', () => change(false));
  show(1);
  head.append(label, shown);
  row.append(head, slider);
  sliders[name] = {slider, show};
  return row;
}
function showLights(known) {
  sliders = {};
  lights = {};
  const none = make('p', {className: 'note', textContent: 'No lights to dim'});
  byId('light-list').replaceChildren(...known.length > 0 ? known.map(lightRow) : [none]);
}
/// Another environment is another light.
async function listLights() {
  const response = await fetch('scene');
  if (!response.ok) return;
  showLights((await response.json()).lights);
  if (frame) takeChanges(frame.about);
}
byId('lights-reset').addEventListener('click', () => {
  lights = {};
  edit({lights: {}, moving: false});
});

// Method and size: if the server rejects a value, it reverts to that of the picture.

byId('method').addEventListener('change', (event) => edit({method: event.target.value}));
for (const id of ['width', 'height'])
  onNumber(id, () => edit({size: ['width', 'height'].map((side) => Math.round(Number(byId(side).value)))}));

function showScene(scene) {
  document.title = `${scene.title} – Lanthorn`;
  byId('title').textContent = scene.title;
  byId('method').replaceChildren(...scene.methods.map(({name, description}) => make('option', {value: name, text: name, title: description})));
  byId('environment-source').replaceChildren(...scene.environments.map(({source, label}) => new Option(label, source)));
  showLights(scene.lights);
  display.curve = byId('curve').value = scene.curve;
  display.auto = byId('auto').checked = scene.measures_exposure;
  setExposure(scene.exposure);
  const warnings = byId('warnings');
  warnings.hidden = scene.warnings.length === 0;
  warnings.querySelector('summary').textContent = `${scene.warnings.length} ${scene.warnings.length === 1 ? 'warning' : 'warnings'}`;
  warnings.querySelector('ul').replaceChildren(...scene.warnings.map((text) => make('li', {textContent: text})));
}

async function start() {
  for (;;) {
    try {
      const response = await fetch('scene');
      if (!response.ok) throw new Error(response.statusText);
      showScene(await response.json());
      return watch();
    } catch {
      lost(true);
      await wait(1000);
    }
  }
}
start();
