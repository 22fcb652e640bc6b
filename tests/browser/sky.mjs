// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The environments of the test, and integrals over them as sums over all texels.

/// A colour for each axis: +X -X +Y -Y +Z -Z.
export const colours = [[2, 0.2, 0.2], [0.2, 2, 2], [0.2, 2, 0.2], [2, 0.2, 2], [0.2, 0.2, 2], [2, 2, 0.2]];

/// One colour for each sixth of the sphere, around each axis, and a sun of one texel.
export function skyOfAxes(sun) {
  return sky((d, x, row) => {
    if (x === 165 && row === 40) return [sun, sun, sun];
    const axis = [0, 1, 2].reduce((a, b) => Math.abs(d[b]) > Math.abs(d[a]) ? b : a);
    return colours[2 * axis + (d[axis] < 0 ? 1 : 0)];
  });
}

export const uniformSky = (rgb) => sky(() => rgb);

/// An equirectangular environment: texels with direction, radiance and solid angle. y is up, +X in the middle.
function sky(radiance) {
  const width = 256, height = 128, texels = [];
  for (let row = 0; row < height; row++)
    for (let x = 0; x < width; x++) {
      const polar = Math.PI * (row + 0.5) / height, azimuth = 2 * Math.PI * (x + 0.5) / width - Math.PI;
      const d = [Math.sin(polar) * Math.cos(azimuth), Math.cos(polar), Math.sin(polar) * Math.sin(azimuth)];
      texels.push({d, rgb: radiance(d, x, row), omega: 2 * Math.PI ** 2 / (width * height) * Math.sin(polar)});
    }
  return {width, height, texels};
}

export function pfm({width, height, texels}) {
  const pixels = new Float32Array(3 * width * height);
  // PFM stores rows from the bottom.
  texels.forEach(({rgb}, i) => pixels.set(rgb, 3 * ((height - 1 - Math.floor(i / width)) * width + i % width)));
  return Buffer.concat([Buffer.from(`PF\n${width} ${height}\n-1.0\n`), Buffer.from(pixels.buffer)]);
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/// Mean of the environment, weighted by a function of the cosine with `direction`.
function mean({texels}, direction, kernel) {
  const sum = [0, 0, 0];
  let weight = 0;
  for (const {d, rgb, omega} of texels) {
    const k = kernel(dot(d, direction)) * omega;
    weight += k;
    for (let c = 0; c < 3; c++) sum[c] += k * rgb[c];
  }
  return sum.map((s) => s / weight);
}

export const irradiance = (environment, n) => mean(environment, n, (cos) => Math.max(cos, 0));

/// Irradiance/pi from bands 0 to 2. The bands of the clamped cosine are 1/4 + c/2 + 5/32 (3 c^2 - 1) (Ramamoorthi & Hanrahan 2001).
export const irradianceOfOrder2 = (environment, n) => mean(environment, n, (c) => 0.25 + c / 2 + 5 / 32 * (3 * c * c - 1));

/// The GGX lobe at n = v = r, weighted by the cosine (Karis 2013).
export const lobe = (environment, r, alpha) =>
    mean(environment, r, (cos) => Math.max(cos, 0) / (1 - (1 - alpha * alpha) * (1 + cos) / 2) ** 2);

/// Reflection of a white environment by GGX with height-correlated Smith masking and Schlick's term: F0 scale + bias.
export function brdf(cosV, alpha) {
  const steps = 400, a2 = alpha * alpha, sinV = Math.sqrt(1 - cosV * cosV), root = (c) => Math.sqrt(a2 + (1 - a2) * c * c);
  let scale = 0, bias = 0;
  for (let i = 0; i < steps; i++)
    for (let k = 0; k < steps; k++) {
      const cosL = (i + 0.5) / steps, sinL = Math.sqrt(1 - cosL * cosL), phi = Math.PI * (k + 0.5) / steps;
      const h = [sinL * Math.cos(phi) + sinV, sinL * Math.sin(phi), cosL + cosV], length = Math.hypot(...h);
      const D = a2 / (Math.PI * (1 - (1 - a2) * (h[2] / length) ** 2) ** 2);
      const V = 0.5 / (cosL * root(cosV) + cosV * root(cosL));
      const schlick = (1 - (h[0] * sinV + h[2] * cosV) / length) ** 5, value = D * V * cosL * 2 * Math.PI / steps ** 2;
      scale += value * (1 - schlick);
      bias += value * schlick;
    }
  return {scale, bias};
}

/// Number of levels of the maps minus one.
const lastLevel = 4;

/// Radiance that an engine shows of a ball {color, metallic, roughness} seen along -z, where its normal is n. Engines: `three`,
/// `filament`, and `split sum`, the code in docs/methods/ibl.md. `pixel` is the width of a pixel.
export function shade(engine, environment, ball, n, pixel) {
  // three.js adds the change of the normal between pixels to the roughness. The last of its table's 16 rows is centred at 15.5/16.
  const turn = engine === 'three' ? pixel * Math.max(1, Math.abs(n[0]) / n[2], Math.abs(n[1]) / n[2]) : 0;
  const roughness = Math.min(ball.roughness + turn, 1), splitSum = engine === 'split sum';
  const {scale, bias} = brdf(n[2], engine === 'three' ? Math.min(roughness, 15.5 / 16) ** 2 : roughness ** 2);
  // On rough surfaces, both engines turn the reflected direction towards the normal (Lagarde & de Rousiers 2014, 4.9.3).
  const bend = splitSum ? 0 : roughness ** 4;
  const r = [2 * n[2] * n[0], 2 * n[2] * n[1], 2 * n[2] * n[2] - 1].map((x, c) => x + bend * (n[c] - x));
  const ofLevel = (i) => lobe(environment, r.map((x) => x / Math.hypot(...r)), (splitSum ? i / lastLevel : 1 - Math.sqrt(1 - i / lastLevel)) ** 2);
  const level = lastLevel * (splitSum ? roughness : roughness * (2 - roughness)), below = ofLevel(Math.floor(level));
  const reflected = ofLevel(Math.ceil(level)).map((above, c) => below[c] + (level - Math.floor(level)) * (above - below[c]));
  const diffuse = engine === 'filament' ? irradianceOfOrder2(environment, n) : irradiance(environment, n);
  return ball.color.map((color, c) => {
    const f0 = ball.metallic ? color : 0.04, base = ball.metallic ? 0 : color, single = f0 * scale + bias;
    if (engine === 'split sum') return base * diffuse[c] + single * reflected[c];
    // Filament's documentation, 4.7.2.
    if (engine === 'filament') return base * (1 - single) * diffuse[c] + single * (1 + f0 * (1 / (scale + bias) - 1)) * reflected[c];
    // Fdez-Aguera 2019, which three.js follows.
    const average = f0 + (1 - f0) / 21, lost = 1 - scale - bias, multiple = single * average * lost / (1 - average * lost);
    return single * reflected[c] + (multiple + base * (1 - single - multiple)) * diffuse[c];
  });
}
