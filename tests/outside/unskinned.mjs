// SPDX-License-Identifier: Apache-2.0
// node unskinned.mjs IN.glb OUT.glb: the same file, its mesh no longer bound to its skin.
import {readFileSync, writeFileSync} from 'node:fs';

const [input, output] = process.argv.slice(2);
const file = readFileSync(input);
const length = file.readUInt32LE(12);
const gltf = JSON.parse(file.toString('utf8', 20, 20 + length));
for (const node of gltf.nodes) delete node.skin;
delete gltf.skins;
const text = Buffer.from(JSON.stringify(gltf).padEnd(length));  // shorter than before: padded to the old length
writeFileSync(output, Buffer.concat([file.subarray(0, 20), text, file.subarray(20 + length)]));
