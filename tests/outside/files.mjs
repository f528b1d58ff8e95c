// SPDX-License-Identifier: Apache-2.0
import {readdirSync, statSync} from 'node:fs';
import {join, resolve} from 'node:path';

// The GLB files that the arguments name: files as they are, folders with all that lies below them, in order of their names.
export function glbFiles(paths) {
  return paths.flatMap((path) => {
    if (!statSync(path).isDirectory()) return [resolve(path)];
    const entries = readdirSync(path).sort().map((name) => join(path, name));
    return glbFiles(entries.filter((entry) => statSync(entry).isDirectory() || entry.endsWith('.glb')));
  });
}
