// make_scene.mjs SCENE.glb OUT.glb: the scene of the demo for the page, a third of its size: textures as WebP (ffmpeg
// encodes them), no tangents, which the renderer derives, and normals in bytes.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [input, output] = process.argv.slice(2);
const file = readFileSync(input);
const jsonBytes = file.readUInt32LE(12);
const gltf = JSON.parse(file.subarray(20, 20 + jsonBytes).toString());
const binary = file.subarray(28 + jsonBytes);

const bytesOf = index => {
  const view = gltf.bufferViews[index];
  return binary.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength);
};

const folder = mkdtempSync(join(tmpdir(), 'brume-scene-'));
function webp(png, isNormal) {
  writeFileSync(join(folder, 'in.png'), png);
  execFileSync(
    'ffmpeg',
    [
      '-v',
      'error',
      '-y',
      '-i',
      'in.png',
      '-c:v',
      'libwebp',
      '-quality',
      isNormal ? '72' : '80',
      '-compression_level',
      '6',
      'out.webp'
    ],
    { cwd: folder }
  );
  return readFileSync(join(folder, 'out.webp'));
}

const views = [],
  parts = [];
let size = 0;
function add(bytes, view = {}) {
  const padded = (bytes.length + 3) & ~3;
  views.push({ buffer: 0, byteOffset: size, byteLength: bytes.length, ...view });
  parts.push(bytes, Buffer.alloc(padded - bytes.length));
  size += padded;
  return views.length - 1;
}

for (const image of gltf.images ?? []) {
  image.bufferView = add(webp(bytesOf(image.bufferView), image.name.endsWith('_normal')));
  image.mimeType = 'image/webp';
}
gltf.textures = gltf.textures?.map(({ source, ...rest }) => ({
  ...rest,
  extensions: { EXT_texture_webp: { source } }
}));

// The accessors that meshes use, with their values.
const accessors = [],
  moved = new Map();
function move(index, convert = accessor => ({ bytes: bytesOf(accessor.bufferView), accessor, view: {} })) {
  if (moved.has(index)) return moved.get(index);
  const { bytes, accessor, view } = convert(gltf.accessors[index]);
  accessors.push({ ...accessor, byteOffset: 0, bufferView: add(bytes, view) });
  moved.set(index, accessors.length - 1);
  return accessors.length - 1;
}
function bytesOfNormals(accessor) {
  const source = bytesOf(accessor.bufferView),
    bytes = Buffer.alloc(4 * accessor.count);
  for (let i = 0; i < accessor.count; ++i)
    for (let axis = 0; axis < 3; ++axis)
      bytes.writeInt8(
        Math.round(127 * source.readFloatLE((accessor.byteOffset ?? 0) + 12 * i + 4 * axis)),
        4 * i + axis
      );
  const { min, max, ...rest } = accessor;
  return { bytes, accessor: { ...rest, componentType: 5120, normalized: true }, view: { byteStride: 4 } };
}
for (const mesh of gltf.meshes)
  for (const primitive of mesh.primitives) {
    const { POSITION, NORMAL, TEXCOORD_0 } = primitive.attributes;
    primitive.attributes = { POSITION: move(POSITION), NORMAL: move(NORMAL, bytesOfNormals) };
    if (TEXCOORD_0 !== undefined) primitive.attributes.TEXCOORD_0 = move(TEXCOORD_0);
    primitive.indices = move(primitive.indices);
  }
rmSync(folder, { recursive: true });

gltf.accessors = accessors;
gltf.bufferViews = views;
gltf.buffers = [{ byteLength: size }];
gltf.extensionsUsed.push('EXT_texture_webp', 'KHR_mesh_quantization');
gltf.extensionsRequired = ['EXT_texture_webp', 'KHR_mesh_quantization'];
const json = Buffer.from(JSON.stringify(gltf));
const jsonChunk = Buffer.concat([json, Buffer.alloc(-json.length & 3, ' ')]);
const chunk = (type, length) => {
  const header = Buffer.alloc(8);
  header.writeUInt32LE(length, 0);
  header.write(type, 4, 'latin1');
  return header;
};
const body = Buffer.concat([chunk('JSON', jsonChunk.length), jsonChunk, chunk('BIN\0', size), ...parts]);
const header = Buffer.alloc(12);
header.write('glTF', 0, 'latin1');
header.writeUInt32LE(2, 4);
header.writeUInt32LE(12 + body.length, 8);
writeFileSync(output, Buffer.concat([header, body]));
