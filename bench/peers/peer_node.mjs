// meshoptimizer of npm (WebAssembly, one thread):  node peer_node.mjs BUILD MESH TARGET_TRIANGLES OUT.ply REPEATS
// The mesh is converted to a plain binary PLY by our command first, welded as for all others.
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const [build, mesh, target, out, repeats] = process.argv.slice(2);
const require = createRequire(path.join(build, '../npm/'));
const { MeshoptSimplifier } = require('meshoptimizer');
await MeshoptSimplifier.ready;

const plain = path.join(build, 'peer_node_input.stl');
execFileSync(path.join(build, 'app/lod'), ['convert', mesh, '-o', plain, '--quiet']);
const bytes = readFileSync(plain);
const count = bytes.readUInt32LE(80);
const places = new Map(), positions = [], indices = new Uint32Array(3 * count);
for (let t = 0; t < count; ++t) {
  for (let k = 0; k < 3; ++k) {
    const at = 84 + 50 * t + 12 + 12 * k, key = bytes.toString('latin1', at, at + 12);
    let v = places.get(key);
    if (v === undefined) {
      v = positions.length / 3;
      places.set(key, v);
      for (let x = 0; x < 3; ++x) positions.push(bytes.readFloatLE(at + 4 * x));
    }
    indices[3 * t + k] = v;
  }
}
const flat = new Float32Array(positions);
let best = Infinity, result;
for (let i = 0; i < Number(repeats); ++i) {
  const begin = performance.now();
  [result] = MeshoptSimplifier.simplify(indices, flat, 3, 3 * Number(target), 1e30);
  best = Math.min(best, (performance.now() - begin) / 1000);
}
const header = `ply\nformat binary_little_endian 1.0\nelement vertex ${flat.length / 3}\nproperty float x\nproperty float y\n` +
  `property float z\nelement face ${result.length / 3}\nproperty list uchar int vertex_indices\nend_header\n`;
const faces = Buffer.alloc((13 * result.length) / 3);
for (let t = 0; t < result.length / 3; ++t) {
  faces.writeUInt8(3, 13 * t);
  for (let k = 0; k < 3; ++k) faces.writeUInt32LE(result[3 * t + k], 13 * t + 1 + 4 * k);
}
writeFileSync(out, Buffer.concat([Buffer.from(header), Buffer.from(flat.buffer), faces]));
console.log(best.toFixed(6));
