// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Usage: node validate_gltf.js FILE...
// Prints what Khronos' validator (npm install -g gltf-validator) says against the files. Exit code 1: errors; 77: it is
// not installed.
'use strict';
const { execFileSync } = require('child_process');
const fs = require('fs');
const path = require('path');

function load() {
  try {
    return require('gltf-validator');
  } catch {
    try {
      const root = execFileSync('npm', ['root', '-g'], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }).trim();
      return require(path.join(root, 'gltf-validator'));
    } catch {
      console.log('gltf-validator is not installed');
      process.exit(77);
    }
  }
}

async function main() {
  const validator = load();
  let errors = 0;
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
      uri: path.basename(file),
      externalResourceFunction: (uri) =>
        fs.promises.readFile(path.join(path.dirname(file), decodeURIComponent(uri))).then((bytes) => new Uint8Array(bytes)),
    });
    for (const message of report.issues.messages)
      if (message.severity === 0) console.log(`${file}${message.pointer}: ${message.code}: ${message.message}`);
    errors += report.issues.numErrors;
  }
  process.exit(errors > 0 ? 1 : 0);
}

main();
