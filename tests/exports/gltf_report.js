// What Khronos' validator says of a file: NODE_PATH=node_modules node gltf_report.js FILE.glb
const {readFileSync} = require("fs");
const {validateBytes} = require("gltf-validator");

validateBytes(new Uint8Array(readFileSync(process.argv[2]))).then(report => console.log(JSON.stringify(report)));
