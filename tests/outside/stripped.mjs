// SPDX-License-Identifier: Apache-2.0
// node stripped.mjs IN.glb OUT.glb: the bare mesh of a rigged character: no skin, no joints, no animation.
import {readFileSync, writeFileSync} from 'node:fs';

const [input, output] = process.argv.slice(2);
const file = readFileSync(input);
const length = file.readUInt32LE(12);
const gltf = JSON.parse(file.toString('utf8', 20, 20 + length));
gltf.nodes = gltf.nodes.filter((node) => 'mesh' in node);
for (const node of gltf.nodes) {
  delete node.skin;
  delete node.children;
}
gltf.scenes = [{nodes: gltf.nodes.map((_, i) => i)}];
gltf.scene = 0;
delete gltf.skins;
delete gltf.animations;
for (const mesh of gltf.meshes)
  for (const primitive of mesh.primitives)
    for (const name of Object.keys(primitive.attributes))
      if (/^(JOINTS|WEIGHTS)_/.test(name)) delete primitive.attributes[name];

const text = Buffer.from(JSON.stringify(gltf));
const padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
const rest = file.subarray(20 + length);
const header = Buffer.from(file.subarray(0, 20));
header.writeUInt32LE(20 + padded.length + rest.length, 8);
header.writeUInt32LE(padded.length, 12);
writeFileSync(output, Buffer.concat([header, padded, rest]));
