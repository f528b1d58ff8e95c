// SPDX-License-Identifier: Apache-2.0
// Blender, headless: the file is one skinned mesh, stands in its bind pose, and moves when a bone is turned.
import {spawnSync} from 'node:child_process';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const script = join(dirname(fileURLToPath(import.meta.url)), 'blender_judge.py');

export function judgeByBlender(files, program = process.env.BLENDER ?? 'blender') {
  const run = spawnSync(program, ['--background', '--factory-startup', '--python', script, '--', ...files], {encoding: 'utf8', maxBuffer: 1 << 28});
  if (run.error) throw run.error;
  const lines = run.stdout.split('\n').filter((line) => line.startsWith('VERDICT ')).map((line) => JSON.parse(line.slice(8)));
  const verdicts = new Map(lines.map(({file, verdict}) => [file, verdict]));
  return files.map((file) => verdicts.get(file) ?? `Blender ended before it: ${run.stderr.trim().split('\n').pop()}`);
}
