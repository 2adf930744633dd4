// node validate_gltf.mjs NODE_MODULES FILE...: what the Khronos validator finds, a line of JSON a file:
// {"file", "errors" (null: no glTF at all), "warnings", "first" (some errors in words)}.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, resolve } from 'node:path';

const [modules, ...files] = process.argv.slice(2);
const validator = createRequire(`${modules}/`)('gltf-validator');
for (const file of files) {
  const load = async (uri) => new Uint8Array(readFileSync(resolve(dirname(file), decodeURIComponent(uri))));
  try {
    const bytes = new Uint8Array(readFileSync(file));
    const { issues } = await validator.validateBytes(bytes, { maxIssues: 0, externalResourceFunction: load });
    const errors = issues.messages.filter((m) => m.severity === 0);
    const first = errors.slice(0, 3).map((e) => `${e.code} ${e.pointer ?? ''} ${e.message}`);
    console.log(JSON.stringify({ file, errors: issues.numErrors, warnings: issues.numWarnings, first }));
  } catch (problem) {
    console.log(JSON.stringify({ file, errors: null, warnings: 0, first: [String(problem)] }));
  }
}
