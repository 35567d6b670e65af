// A glTF file as the Khronos validator and as three.js see it.
import fs from 'node:fs';
import {createRequire} from 'node:module';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const modules = path.resolve(process.env.FOCAL_VIEWERS, 'node_modules');
const validator = createRequire(path.join(modules, 'here.js'))('gltf-validator');
const three = (file) => import(pathToFileURL(path.join(modules, 'three', file)).href);
globalThis.self = globalThis;  // two names of browsers that the loader uses and Node lacks
globalThis.ProgressEvent ??= class extends Event {};
const {AnimationMixer, Box3, Vector3, LoadingManager, LoopOnce, PropertyBinding, SkinnedMesh, Texture} = await three('build/three.module.js');
const {GLTFLoader} = await three('examples/jsm/loaders/GLTFLoader.js');
const {VRMLoaderPlugin} = await import(pathToFileURL(path.join(modules, '@pixiv/three-vrm/lib/three-vrm.module.js')).href);

export const sidesOf = (box) => box.getSize(new Vector3()).toArray().sort((a, b) => a - b);
export const viewerName = (name) => PropertyBinding.sanitizeNodeName(name ?? '');

// The loader would scale weights to sum 1, and so hide those that do not: they are counted instead.
SkinnedMesh.prototype.normalizeSkinWeights = function() {
  const weights = this.geometry.attributes.skinWeight;
  this.userData.badWeights = 0;
  for (let v = 0; v < weights.count; ++v) {
    const four = [weights.getX(v), weights.getY(v), weights.getZ(v), weights.getW(v)];
    const sum = four.reduce((a, b) => a + b);
    if (!(Math.abs(sum - 1) < 1e-5) || Math.min(...four) < 0) ++this.userData.badWeights;
  }
};

const besides = (file, uri) => new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri))));

async function validate(file, add) {
  const options = {maxIssues: 0, externalResourceFunction: async (uri) => besides(file, uri)};
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), options);
  for (const {severity, code} of report.issues.messages) {
    if (severity < 2) add(`${severity === 0 ? 'error' : 'warning'}: ${code}`);
  }
}

function load(file) {
  const inline = (uri) => uri.startsWith('data:') ?
      uri :
      'data:application/octet-stream;base64,' + Buffer.from(besides(file, uri)).toString('base64');
  const loader = new GLTFLoader(new LoadingManager().setURLModifier(inline));
  loader.register((parser) => new VRMLoaderPlugin(parser));
  loader.register(() => ({name: 'no pictures', loadTexture: async () => new Texture()}));  // Node decodes none
  return loader.parseAsync(new Uint8Array(fs.readFileSync(file)).buffer, '');
}

// The bones of the skins that meshes use: their names in the file and as shown, and the file's name of the bone above each in
// the viewer.
function bonesOf(scene, nodeOf, json, add) {
  const bones = new Map();
  scene.traverse((mesh) => {
    if (!mesh.isSkinnedMesh) return;
    const node = nodeOf(mesh) ?? nodeOf(mesh.parent);  // several primitives are a group of meshes
    const {joints} = json.skins[json.nodes[node].skin];
    const found = mesh.skeleton.bones;
    if (joints.length !== found.length || joints.some((joint, i) => nodeOf(found[i]) !== joint))
      add('error: the bones of a skin are not its joints');
    for (const bone of found) {
      const index = nodeOf(bone);
      const parent = json.nodes.findIndex((other) => other.children?.includes(index));
      if (!bone.isBone || (nodeOf(bone.parent) ?? -1) !== parent) add('error: a bone is not where the file has it');
      bones.set(bone, json.nodes[index].name ?? '');
    }
    if (mesh.userData.badWeights > 0) add('error: weights do not sum to 1', mesh.userData.badWeights);
  });
  return [...bones].map(([bone, name]) => ({name, shown: bone.name, parent: bones.get(bone.parent) ?? null}));
}

function play(gltf, nodeOf, json, add) {
  const mixer = new AnimationMixer(gltf.scene);
  gltf.animations.forEach((clip, index) => {
    const bound = new Set(clip.tracks.map((track) => {
      const {nodeName} = PropertyBinding.parseTrackName(track.name);
      return nodeOf(PropertyBinding.findNode(gltf.scene, nodeName));
    }));
    for (const {target} of json.animations[index].channels) {
      if (target.path !== 'weights' && !bound.has(target.node)) add('error: an animation does not bind');
    }
    mixer.clipAction(clip).play();
    mixer.update(clip.duration / 2);
    mixer.stopAllAction();
  });
}

// -> {json, faults: Map from a fault to how often it is there, bones, clips: names, box: of the mesh as it stands, bindBox: as it was bound}
export async function look(file) {
  const faults = new Map();
  const add = (fault, count = 1) => faults.set(fault, (faults.get(fault) ?? 0) + count);
  console.warn = console.error = (...words) => add(`warning: three.js says ${words.join(' ')}`);
  await validate(file, add);
  const gltf = await load(file);
  const json = gltf.parser.json;
  const nodeOf = (object) => gltf.parser.associations.get(object)?.nodes;
  gltf.scene.updateMatrixWorld(true);
  const box = new Box3().setFromObject(gltf.scene, true);
  const bones = bonesOf(gltf.scene, nodeOf, json, add);
  play(gltf, nodeOf, json, add);
  gltf.scene.traverse((mesh) => mesh.skeleton?.pose());
  gltf.scene.updateMatrixWorld(true);
  const bindBox = new Box3().setFromObject(gltf.scene, true);
  return {json, faults, bones, clips: gltf.animations.map((clip) => clip.name), box, bindBox};
}

// Of the first morph target of every mesh that has some, at a time of a clip.
export async function influences(file, clip, seconds) {
  const gltf = await load(file);
  const mixer = new AnimationMixer(gltf.scene);
  const action = mixer.clipAction(gltf.animations.find(({name}) => name === clip));
  action.clampWhenFinished = true;
  action.setLoop(LoopOnce);
  action.play();
  mixer.update(seconds);
  const found = [];
  gltf.scene.traverse((mesh) => found.push(...(mesh.morphTargetInfluences ?? []).slice(0, 1)));
  return found;
}

// What an engine of avatars would miss in a VRM file in a T-pose: names of bones, meta data, and arms that come down when it lowers them.
export async function avatarFaults(file, meta) {
  const {vrm} = (await load(file)).userData;
  if (!vrm) return ['error: three-vrm finds no avatar'];
  const faults = [];
  if (vrm.meta.metaVersion !== '1' || vrm.meta.name !== meta.name || String(vrm.meta.authors) !== String(meta.authors))
    faults.push('error: the meta data of the avatar is lost');
  const place = (bone) => vrm.humanoid.getRawBoneNode(bone).getWorldPosition(new Vector3());
  const width = () => new Box3().setFromObject(vrm.scene, true).getSize(new Vector3()).x;
  vrm.scene.updateMatrixWorld(true);
  const before = ['left', 'right'].map((side) => ({side, arm: place(`${side}UpperArm`), hand: place(`${side}Hand`)})), spread = width();
  for (const {side} of before) vrm.humanoid.getNormalizedBoneNode(`${side}UpperArm`).rotation.z = side === 'left' ? -Math.PI / 2 : Math.PI / 2;
  vrm.update(0);
  vrm.scene.updateMatrixWorld(true);
  for (const {side, arm, hand} of before) {
    const length = hand.distanceTo(arm), lowered = arm.clone().add(new Vector3(0, -length, 0));
    if (!(Math.abs(hand.y - arm.y) < 0.1 * length)) faults.push(`error: the ${side} arm of the avatar is not level`);
    if (!(place(`${side}Hand`).distanceTo(lowered) < 0.1 * length)) faults.push(`error: the ${side} arm of the avatar does not come down`);
  }
  if (!(width() < 0.7 * spread)) faults.push('error: the mesh of the avatar does not follow its arms');
  return faults;
}
