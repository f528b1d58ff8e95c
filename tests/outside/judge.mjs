// SPDX-License-Identifier: Apache-2.0
// node judge.mjs [--without NAME]... FILE|FOLDER...
// Has every GLB judged by programs of others: Khronos' validator, three.js in Chromium, Blender. Prints a table; exit code 1 if anyone
// finds fault with a file. NAME: validator, three, blender.
import {basename} from 'node:path';
import {judgeByBlender} from './blender.mjs';
import {glbFiles} from './files.mjs';
import {judgeByThree} from './three.mjs';
import {judgeByValidator} from './validator.mjs';

const judges = {validator: judgeByValidator, three: judgeByThree, blender: judgeByBlender};
const paths = [];
for (let i = 2; i < process.argv.length; ++i) {
  if (process.argv[i] === '--without') delete judges[process.argv[++i]];
  else paths.push(process.argv[i]);
}
const files = glbFiles(paths);
if (files.length === 0) throw new Error('no GLB file named');

const names = Object.keys(judges);
const verdicts = {};
for (const name of names) verdicts[name] = await judges[name](files);

const width = Math.max(...files.map((file) => basename(file).length));
console.log(['file'.padEnd(width), ...names.map((name) => name.padEnd(9))].join('  '));
for (const [i, file] of files.entries()) {
  console.log([basename(file).padEnd(width), ...names.map((name) => (verdicts[name][i] ? 'FAULT' : 'ok').padEnd(9))].join('  '));
  for (const name of names) if (verdicts[name][i]) console.log(`    ${name}: ${verdicts[name][i]}`);
}
const bad = files.filter((_, i) => names.some((name) => verdicts[name][i])).length;
console.log(`${files.length - bad} of ${files.length} files pass ${names.join(', ')}`);
process.exitCode = bad ? 1 : 0;
