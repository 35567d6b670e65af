// The .gltf of a .glb, its buffer within the JSON.
// usage: node to_gltf.mjs IN.glb OUT.gltf
import fs from 'node:fs';
import {readGlb} from './glb.mjs';

const [source, target] = process.argv.slice(2);
const {json, binary} = readGlb(source);
const bytes = binary.subarray(0, json.buffers[0].byteLength);
json.buffers[0].uri = 'data:application/octet-stream;base64,' + bytes.toString('base64');
fs.writeFileSync(target, JSON.stringify(json));
