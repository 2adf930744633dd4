// node load_three.mjs NODE_MODULES FILE: loads a GLB with three.js and tells what is in it. Node decodes no images, so textures
// count by their materials' slots and their pictures are left empty.
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const [modules, file] = process.argv.slice(2);
globalThis.self = globalThis;
globalThis.createImageBitmap = async () => ({ width: 1, height: 1, close() {} });
const { GLTFLoader } = await import(pathToFileURL(`${modules}/three/examples/jsm/loaders/GLTFLoader.js`));

const bytes = readFileSync(file);
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
const gltf = await new GLTFLoader().parseAsync(buffer, '');
let meshes = 0;
let triangles = 0;
gltf.scene.traverse((object) => {
  if (!object.isMesh) return;
  meshes += 1;
  const { index, attributes } = object.geometry;
  triangles += (index ? index.count : attributes.position.count) / 3;
});
const json = gltf.parser.json;
console.log(`meshes ${meshes} triangles ${triangles} skins ${(json.skins ?? []).length} animations ${gltf.animations.length}`);
process.exit(meshes > 0 && triangles > 0 ? 0 : 1);
