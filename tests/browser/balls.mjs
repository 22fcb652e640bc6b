// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Balls of radius 1, 3 apart along x, which the engines light with the maps: as a list, and as a binary glTF file.

export const balls = [
  {name: 'white metal', color: [1, 1, 1], metallic: 1, roughness: 0.5},
  {name: 'rough white metal', color: [1, 1, 1], metallic: 1, roughness: 1},
  {name: 'gold', color: [0.9, 0.6, 0.3], metallic: 1, roughness: 0.5},
  {name: 'rough gold', color: [0.9, 0.6, 0.3], metallic: 1, roughness: 1},
  {name: 'white plastic', color: [1, 1, 1], metallic: 0, roughness: 0.5}];

/// Width and height of a ball's picture in pixels; `places` are pixels in it, counted from the lower left.
export const across = 257;
export const places = [[128, 128], [190, 150], [70, 190], [120, 60]];
export function normalAt([column, row]) {
  const x = (2 * column + 1) / across - 1, y = (2 * row + 1) / across - 1;
  return [x, y, Math.sqrt(1 - x * x - y * y)];
}

function sphere() {
  const turns = 128, rings = 64, positions = [], indices = [];
  for (let j = 0; j <= rings; j++)
    for (let i = 0; i <= turns; i++) {
      const polar = Math.PI * j / rings, azimuth = 2 * Math.PI * i / turns;
      positions.push(Math.sin(polar) * Math.cos(azimuth), Math.cos(polar), -Math.sin(polar) * Math.sin(azimuth));
      const at = j * (turns + 1) + i;
      if (i < turns && j < rings) indices.push(at, at + turns + 1, at + 1, at + 1, at + turns + 1, at + turns + 2);
    }
  return {positions: new Float32Array(positions), indices: new Uint16Array(indices)};
}

/// The balls as .glb. Vertex positions of a unit sphere are also its normals.
export function ballsAsGlb() {
  const {positions, indices} = sphere(), count = positions.length / 3;
  const json = {
    asset: {version: '2.0'}, scene: 0, scenes: [{nodes: balls.map((_, i) => i)}],
    nodes: balls.map((_, i) => ({mesh: i, translation: [3 * i, 0, 0]})),
    meshes: balls.map((_, i) => ({primitives: [{attributes: {POSITION: 0, NORMAL: 0}, indices: 1, material: i}]})),
    materials: balls.map(({color, metallic, roughness}) => ({pbrMetallicRoughness: {
      baseColorFactor: [...color, 1], metallicFactor: metallic, roughnessFactor: roughness}})),
    accessors: [
      {bufferView: 0, componentType: 5126, count, type: 'VEC3', min: [-1, -1, -1], max: [1, 1, 1]},
      {bufferView: 1, componentType: 5123, count: indices.length, type: 'SCALAR'}],
    bufferViews: [{buffer: 0, byteOffset: 0, byteLength: positions.byteLength, target: 34962},
                  {buffer: 0, byteOffset: positions.byteLength, byteLength: indices.byteLength, target: 34963}],
    buffers: [{byteLength: positions.byteLength + indices.byteLength}]};
  const chunk = (type, bytes, fill) => {
    const padded = Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3, fill)]), head = Buffer.alloc(8);
    head.writeUInt32LE(padded.length, 0);
    head.write(type, 4, 'latin1');
    return Buffer.concat([head, padded]);
  };
  const body = Buffer.concat([chunk('JSON', Buffer.from(JSON.stringify(json)), ' '),
                              chunk('BIN\0', Buffer.concat([Buffer.from(positions.buffer), Buffer.from(indices.buffer)]), 0)]);
  const header = Buffer.alloc(12);
  header.write('glTF', 0, 'latin1');
  header.writeUInt32LE(2, 4);
  header.writeUInt32LE(12 + body.length, 8);
  return Buffer.concat([header, body]);
}
