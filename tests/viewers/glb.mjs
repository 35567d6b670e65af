// Binary glTF taken apart and put together.
import fs from 'node:fs';

const jsonChunk = 0x4e4f534a, binaryChunk = 0x004e4942;

export function readGlb(file) {
  const bytes = fs.readFileSync(file);
  const length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.toString('utf8', 20, 20 + length));
  return {json, binary: bytes.subarray(28 + length)};  // behind the second chunk's header
}

export function writeGlb(file, {json, binary}) {
  const chunk = (kind, bytes, filler) => {
    const padded = Buffer.alloc(8 + Math.ceil(bytes.length / 4) * 4, filler);
    padded.writeUInt32LE(padded.length - 8, 0);
    padded.writeUInt32LE(kind, 4);
    bytes.copy(padded, 8);
    return padded;
  };
  const chunks = [chunk(jsonChunk, Buffer.from(JSON.stringify(json)), ' '), chunk(binaryChunk, binary, 0)];
  const header = Buffer.from('glTF\x02\0\0\0\0\0\0\0', 'latin1');
  header.writeUInt32LE(12 + chunks[0].length + chunks[1].length, 8);
  fs.writeFileSync(file, Buffer.concat([header, ...chunks]));
}
