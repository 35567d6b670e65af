// Every glTF file that focal wrote is valid, and looks in three.js as it should; a file that is spoiled is found out.
// usage: FOCAL_VIEWERS=FOLDER_OF_NODE_MODULES node check.mjs LIST
//   LIST: lines of WRITTEN, INPUT and how it was written, between tabs: rig, keep (other weights), detect, votes, parts.
//   WRITTEN.json: what `focal rig --json` said of a rig
import fs from 'node:fs';
import {readGlb, writeGlb} from './glb.mjs';
import {spoilers} from './spoilers.mjs';
import {avatarFaults, look, sidesOf, viewerName} from './viewers.mjs';

const looks = new Map();
async function lookOnce(file) {
  if (!looks.has(file)) looks.set(file, await look(file));
  return looks.get(file);
}

// A validator's finding or one of three.js is a fault where the input has fewer of the kind.
function newFaults(before, after, verb) {
  const faults = [];
  for (const [fault, count] of after.faults) {
    // A rig has weights of its own.
    const inherited = (verb === 'rig' || verb === 'keep') && /weights/i.test(fault) ? 0 : before.faults.get(fault) ?? 0;
    if (count > inherited) faults.push(`${fault} (${count}, in its input ${inherited})`);
  }
  return faults;
}

// wanted: [{name, parent: a name or null}]
function boneFaults(wanted, before, after) {
  const line = ({name, parent}) => `bone ${viewerName(name)} under ${parent === null ? 'none' : viewerName(parent)}`;
  const given = after.bones.map(line), asked = wanted.map(line);
  const faults = asked.filter((bone) => !given.includes(bone)).map((bone) => `error: lacks ${bone}`);
  faults.push(...given.filter((bone) => !asked.includes(bone)).map((bone) => `error: nobody asked for ${bone}`));
  if (given.length !== asked.length) faults.push(`error: ${given.length} bones, not ${asked.length}`);
  // three.js numbers names that come again. That is focal's fault unless an object of the input has the name.
  const taken = new Set(Object.values(before.json).flat().map((object) => viewerName(object?.name)));
  for (const {name, shown} of renamedOf(after)) {
    if (!taken.has(viewerName(name))) faults.push(`error: bone ${name} is called ${shown}`);
  }
  return faults;
}

const renamedOf = ({bones}) => bones.filter(({name, shown}) => shown !== viewerName(name));

function lostClips(wanted, after) {
  const left = [...after.clips];
  return wanted.filter((clip) => {
    const at = left.indexOf(clip);
    if (at >= 0) left.splice(at, 1);
    return at < 0;
  });
}

// How far the box around the mesh has moved, as a share of its size.
const moved = (before, after) =>
    (before.min.distanceTo(after.min) + before.max.distanceTo(after.max)) / before.min.distanceTo(before.max);

// Whether one box is the other moved, turned by right angles and scaled.
function alike(one, other) {
  const [a, b] = [sidesOf(one), sidesOf(other)];
  return a.every((side, i) => Math.abs(side / a[2] - b[i] / b[2]) < 0.05);
}

// Whether three.js shows the input as it is: it moves a vertex by four joints, and some files place one nowhere.
function isShown({json, box}) {
  const primitives = (json.meshes ?? []).flatMap((mesh) => mesh.primitives);
  return !primitives.some(({attributes}) => 'WEIGHTS_1' in attributes) && !Number.isNaN(box.min.length() + box.max.length());
}

// Lines of faults, and what three.js made of the file.
async function judge({written, input, how}) {
  const [verb, ...words] = how.trim().split(' ');
  const before = await lookOnce(input), after = await look(written);
  const faults = newFaults(before, after, verb);

  let bones = [];  // pictures of votes and parts have none
  if (verb === 'detect' || verb === 'keep') bones = before.bones;
  if (verb === 'rig') bones = JSON.parse(fs.readFileSync(written.replace(/\.spoiled/, '') + '.json')).joints;
  faults.push(...boneFaults(bones, before, after));

  const clips = ['rig', 'detect', 'keep'].includes(verb) ? [...before.clips] : [];
  if (words.includes('--animations')) {  // they get a number where the mesh has one of that name
    for (const clip of (await lookOnce(words[words.indexOf('--animations') + 1])).clips) {
      let name = clip;
      for (let number = 2; clips.includes(name); ++number) name = `${clip} (${number})`;
      clips.push(name);
    }
  }
  for (const clip of lostClips(clips, after)) faults.push(`error: animation ${clip} is lost`);

  if (words.includes('--vrm')) {
    const meta = JSON.parse(fs.readFileSync(words[words.indexOf('--vrm') + 1]));
    faults.push(...await avatarFaults(written, meta));
  }

  // What has a skin gets another in the pose in which it was bound; the pose shown may be another.
  const wasBound = before.bones.length > 0 && verb !== 'detect';
  const tolerance = wasBound ? 0.1 : 1e-4;
  const distance = wasBound && alike(before.bindBox, after.box) ? 0 : moved(before.box, after.box);
  if (!words.includes('--rest-pose') && !words.includes('--pose') && isShown(before) && !(distance < tolerance))
    faults.push(`error: it stands elsewhere, by ${distance.toPrecision(2)} of its size`);
  return {faults, after};
}

// The kinds of spoiling that go unnoticed.
async function blindSpots(file) {
  const blind = [];
  for (const [fault, spoil] of Object.entries(spoilers)) {
    const glb = readGlb(file.written);
    spoil(glb);
    const written = file.written.replace(/glb$/, 'spoiled.glb');
    writeGlb(written, glb);
    const {faults} = await judge({...file, written});
    if (!faults.some((one) => one.startsWith(fault)))
      blind.push(`'${fault}' goes unnoticed; found: ${faults.join('; ') || 'nothing'}`);
  }
  return blind;
}

const files = fs.readFileSync(process.argv[2], 'utf8').trimEnd().split('\n').map((line) => {
  const [written, input, how] = line.split('\t');
  return {written, input, how};
});
let errors = 0, warnings = 0, bones = 0, renamed = 0;
for (const file of files) {
  const {faults, after} = await judge(file);
  for (const fault of faults) console.log(`${file.written} (${file.how}): ${fault}`);
  errors += faults.filter((fault) => fault.startsWith('error')).length;
  warnings += faults.filter((fault) => fault.startsWith('warning')).length;
  bones += after.bones.length;
  renamed += renamedOf(after).length;
}
const blind = await blindSpots(files.find(({how}) => how.includes('--animations')));
for (const line of blind) console.log(line);
console.log(`viewers: of ${Object.keys(spoilers).length} spoiled files ${blind.length} went unnoticed; ` +
            `${renamed} bones are numbered by three.js, as the input's own objects have their names`);
console.log(`viewers: ${files.length} files, ${errors} errors, ${warnings} new warnings, ${bones} bones`);
process.exitCode = errors + warnings + blind.length > 0 ? 1 : 0;
