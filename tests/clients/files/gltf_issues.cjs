// Run by Node: what Khronos's own validator says of a GLB, one line of JSON.
//   node gltf_issues.cjs MODULES_FOLDER FILE
const fs = require('node:fs');
const path = require('node:path');

const validator = require(path.join(process.argv[2], 'gltf-validator'));
validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[3]))).then((report) => {
  console.log(JSON.stringify({ errors: report.issues.numErrors, warnings: report.issues.numWarnings,
    messages: report.issues.messages.slice(0, 10) }));
});
