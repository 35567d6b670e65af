// What may be wrong with a rigged and animated .glb: the fault that must be found, and how to bring it about.

const firstAttribute = (json, name) => json.accessors[json.meshes[0].primitives[0].attributes[name]];
const above = (json, node) => json.nodes.find((other) => other.children?.includes(node));

export const spoilers = {
  'error: ACCESSOR_MAX_MISMATCH': ({json}) => { firstAttribute(json, 'POSITION').max[0] += 1; },
  'error: weights do not sum to 1': ({json, binary}) => {
    const {bufferView, byteOffset = 0} = firstAttribute(json, 'WEIGHTS_0');
    const at = byteOffset + (json.bufferViews[bufferView].byteOffset ?? 0);
    binary.writeFloatLE(0.5 * binary.readFloatLE(at), at);
  },
  'error: lacks bone': ({json}) => { json.nodes[json.skins[0].joints[1]].name = 'somebody'; },
  'error: nobody asked for bone': ({json}) => {  // its parent becomes its sibling
    const leaf = json.skins[0].joints.at(-1), parent = above(json, leaf);
    above(json, json.nodes.indexOf(parent)).children.push(leaf);
    parent.children = parent.children.filter((child) => child !== leaf);
  },
  'error: bone': ({json}) => {  // is called otherwise: an object before it has its name
    json.nodes.push({name: json.nodes[json.skins[0].joints[1]].name});
    json.scenes[0].nodes.unshift(json.nodes.length - 1);
  },
  'error: it stands elsewhere': ({json}) => { json.nodes[json.skins[0].joints[0]].translation = [0, 9, 0]; },
  'error: an animation does not bind': ({json}) => {
    json.animations[0].channels[0].target.node = json.nodes.push({name: 'not in the scene'}) - 1;
  },
  'error: animation': ({json}) => { json.animations.pop(); }  // is lost
};
