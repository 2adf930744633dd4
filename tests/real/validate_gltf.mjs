// node validate_gltf.mjs NODE_MODULES FILE: the Khronos validator's errors, exit 1 if there are any.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const [modules, file] = process.argv.slice(2);
const validator = createRequire(`${modules}/`)('gltf-validator');
const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 0 });
const errors = report.issues.messages.filter((m) => m.severity === 0);
for (const e of errors.slice(0, 5)) console.log(`${e.code} ${e.pointer ?? ''} ${e.message}`);
console.log(`${report.issues.numErrors} errors, ${report.issues.numWarnings} warnings`);
process.exit(report.issues.numErrors > 0 ? 1 : 0);
