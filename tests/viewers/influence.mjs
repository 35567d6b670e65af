// Does three.js show a morph target as a clip has it? Fails unless its influence is as wanted on every mesh that has one.
// usage: FOCAL_VIEWERS=FOLDER_OF_NODE_MODULES node influence.mjs FILE CLIP SECONDS INFLUENCE
import {influences} from './viewers.mjs';

const [file, clip, seconds, wanted] = process.argv.slice(2);
const found = await influences(file, clip, Number(seconds));
console.log(`${file}: influences of '${clip}' at ${seconds} s: ${found.join(', ')}`);
process.exitCode = found.length > 0 && found.every((influence) => Math.abs(influence - Number(wanted)) < 1e-6) ? 0 : 1;
