// SPDX-License-Identifier: Apache-2.0
// Khronos' glTF validator: no errors, no warnings.
import {readFileSync} from 'node:fs';
import {validateBytes} from 'gltf-validator';

const describe = (message) => `${message.code} at ${message.pointer ?? 'offset ' + message.offset}: ${message.message}`;

// One verdict ('' if all is well, else what is wrong) for each file.
export async function judgeByValidator(files) {
  const verdicts = [];
  for (const file of files) {
    try {
      const report = await validateBytes(new Uint8Array(readFileSync(file)), {maxIssues: 100});
      const {numErrors, numWarnings, messages} = report.issues;
      verdicts.push(numErrors + numWarnings === 0 ? '' : `${numErrors} errors, ${numWarnings} warnings; first: ${describe(messages[0])}`);
    } catch (e) {
      verdicts.push(`not readable: ${e}`);
    }
  }
  return verdicts;
}
