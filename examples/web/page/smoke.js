// The smoke in the picture: textures that follow what a player sees, and the shader's part that reads them. All that
// depends on how smoke gets to the renderer is here; the shader itself is Brume's, shaders/export.
import * as THREE from 'three';
import SMOKE from './smoke.glsl';
import MARCH from './smoke_march.glsl';
import { LEVEL } from './level.js';

const ALBEDO = [0.9, 0.91, 0.93],
  ANISOTROPY = 0.3,
  AMBIENT = [0.0075, 0.0115, 0.021],
  BOUNCE = 0.3; // what surfaces reflect
const DIMMEST = 0.05; // irradiance of a lamp that counts [W/m^2]
const LAMPS = 15;

// What WebGL calls brume_texture_format: internal format, format, type, and the array of its texels.
const FORMATS = [
  null,
  ['R8', 'RED', 'UNSIGNED_BYTE', Uint8Array],
  ['RG8', 'RG', 'UNSIGNED_BYTE', Uint8Array],
  ['RGBA8', 'RGBA', 'UNSIGNED_BYTE', Uint8Array],
  ['RGBA16F', 'RGBA', 'HALF_FLOAT', Uint16Array],
  ['RGBA32F', 'RGBA', 'FLOAT', Float32Array],
  ['R16UI', 'RED_INTEGER', 'UNSIGNED_SHORT', Uint16Array],
  ['R32UI', 'RED_INTEGER', 'UNSIGNED_INT', Uint32Array],
  ['RG32UI', 'RG_INTEGER', 'UNSIGNED_INT', Uint32Array],
  ['RGBA32UI', 'RGBA_INTEGER', 'UNSIGNED_INT', Uint32Array]
];
// brume_texture_kind: name in the shader, whether it is flat, filtered, repeats.
const KINDS = [
  ['brume_density', false, true],
  ['brume_displacement', false, true],
  ['brume_pages', false, false],
  ['brume_cells', false, false],
  ['brume_boundary', true, false],
  ['brume_corners', true, false],
  ['brume_holes', true, false],
  ['brume_masks', true, true],
  ['brume_noise', false, true, true],
  ['brume_detail', false, true, true],
  ['brume_light_volume', false, true]
].map(([name, isFlat, isLinear, repeats = false]) => ({ name, isFlat, isLinear, repeats }));

/** The textures of one player's smoke, on the device. */
class Textures {
  constructor(renderer) {
    this.renderer = renderer;
    this.gl = renderer.getContext();
    this.generations = KINDS.map(() => 0);
    this.handles = KINDS.map(() => new THREE.ExternalTexture());
    this.uniforms = Object.fromEntries(KINDS.map(({ name }, i) => [name, { value: this.handles[i] }]));
  }

  #make(kind, { format, width, height, depth }) {
    const { gl, renderer } = this,
      { isFlat, isLinear, repeats } = KINDS[kind];
    const properties = renderer.properties.get(this.handles[kind]);
    if (properties.__webglTexture) gl.deleteTexture(properties.__webglTexture);
    const texture = gl.createTexture(),
      target = isFlat ? gl.TEXTURE_2D : gl.TEXTURE_3D;
    renderer.state.bindTexture(target, texture);
    const levels = repeats ? Math.floor(Math.log2(width)) + 1 : 1,
      internal = gl[FORMATS[format][0]];
    if (isFlat) gl.texStorage2D(target, levels, internal, width, height);
    else gl.texStorage3D(target, levels, internal, width, height, depth);
    const filter = isLinear ? gl.LINEAR : gl.NEAREST;
    gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, repeats ? gl.LINEAR_MIPMAP_LINEAR : filter);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
      gl.texParameteri(target, axis, repeats ? gl.REPEAT : gl.CLAMP_TO_EDGE);
    this.handles[kind].sourceTexture = properties.__webglTexture = texture;
  }

  /** Makes what is new and uploads what has changed. Returns the bytes. */
  follow({ textures, regions }, memory) {
    const { gl, renderer } = this;
    renderer.state.activeTexture(gl.TEXTURE0);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    textures.forEach((texture, kind) => {
      if (texture.generation === this.generations[kind]) return;
      this.#make(kind, texture);
      this.generations[kind] = texture.generation;
    });
    let uploaded = 0;
    for (const { texture: kind, x, y, z, width, height, depth, at, bytes } of regions) {
      const [, format, type, Texels] = FORMATS[textures[kind].format],
        target = KINDS[kind].isFlat ? gl.TEXTURE_2D : gl.TEXTURE_3D;
      const texels = new Texels(memory, at, bytes / Texels.BYTES_PER_ELEMENT);
      renderer.state.bindTexture(target, this.handles[kind].sourceTexture);
      if (KINDS[kind].isFlat) gl.texSubImage2D(target, 0, x, y, width, height, gl[format], gl[type], texels);
      else gl.texSubImage3D(target, 0, x, y, z, width, height, depth, gl[format], gl[type], texels);
      if (KINDS[kind].repeats) gl.generateMipmap(target);
      uploaded += bytes;
    }
    renderer.state.unbindTexture();
    return uploaded;
  }
}

/** Uniforms of the lamps, as lampsOf has them. */
function lampUniforms(lamps) {
  const rows = pick =>
    Array.from({ length: LAMPS }, (_, i) => (i < lamps.length ? pick(lamps[i]) : new THREE.Vector4()));
  return {
    lamp_at: {
      value: rows(
        lamp => new THREE.Vector4(...(lamp.towards ?? lamp.position), lamp.towards ? 2 : lamp.direction ? 1 : 0)
      )
    },
    lamp_intensity: { value: rows(lamp => new THREE.Vector4(...lamp.color, 0)) },
    lamp_cone: { value: rows(lamp => new THREE.Vector4(...(lamp.direction ?? [0, 0, 0]), lamp.outer ?? 0)) },
    lamp_inner: { value: Float32Array.from({ length: LAMPS }, (_, i) => lamps[i]?.inner ?? 0) },
    lamp_list: { value: new Int32Array(LAMPS) },
    lamp_count: { value: 0 }
  };
}

export class Smoke {
  constructor(renderer, lamps) {
    this.lamps = lamps;
    this.textures = new Textures(renderer);
    const size = LEVEL.size.map(n => Math.ceil(n / 2));
    this.left = new THREE.Data3DTexture(new Uint8Array(4 * size[0] * size[1] * size[2]).fill(255), ...size);
    this.left.minFilter = this.left.magFilter = THREE.LinearFilter;
    this.left.needsUpdate = true;
    this.uploaded = 0;
    this.uniforms = {
      ...this.textures.uniforms,
      ...lampUniforms(lamps),
      brume_constants: { value: new Float32Array(40) },
      albedo: { value: new THREE.Vector4(...ALBEDO, ANISOTROPY) },
      ambient: { value: new THREE.Vector4(...AMBIENT, BOUNCE) },
      light_left: { value: this.left },
      light_origin: { value: new THREE.Vector3(...LEVEL.origin) },
      light_extent: { value: new THREE.Vector3(...size).multiplyScalar(2 * LEVEL.voxel) }
    };
  }

  /** The device has lost all textures: the next answer has them whole. */
  forget() {
    this.textures.generations.fill(0);
    this.left.needsUpdate = true;
  }

  /** Uploads what has changed: `seen` is of an answer of the worker. */
  follow({ textures, regions, texels, constants, left }) {
    this.constants = constants;
    this.uploaded = this.textures.follow({ textures, regions }, texels) + left.byteLength;
    this.#chooseLamps(constants.subarray(16, 19), constants.subarray(20, 23));
    this.left.image.data.set(left);
    this.left.needsUpdate = true;
  }

  /** Longer steps than the smoke asks for, by a factor. */
  set stepScale(scale) {
    if (!this.constants) return;
    const constants = this.uniforms.brume_constants.value;
    constants.set(this.constants);
    constants[19] *= scale;
  }

  /** Whether there is smoke: between BRUME_LOW and BRUME_HIGH. */
  get isThere() {
    return Boolean(this.constants) && this.constants[20] > this.constants[16];
  }

  /** The lamps that light the smoke between two corners: what others add is not seen. */
  #chooseLamps(low, high) {
    const isSeen = ({ towards, position, color }) => {
      const peak = Math.max(...color);
      if (towards) return peak > DIMMEST;
      const square = position.reduce((sum, p, i) => sum + Math.max(low[i] - p, 0, p - high[i]) ** 2, 0);
      return peak > DIMMEST * square;
    };
    const chosen = this.lamps.flatMap((lamp, i) => (isSeen(lamp) ? [i] : []));
    this.uniforms.lamp_list.value.set(chosen);
    this.uniforms.lamp_count.value = chosen.length;
  }

  /** Samples of a ray at most. */
  get samplesOfRay() {
    const constants = this.uniforms.brume_constants.value;
    return this.isThere
      ? Math.hypot(...[0, 1, 2].map(i => constants[20 + i] - constants[16 + i])) / constants[19]
      : 0;
  }
}

/** brume_march(), with the lamps of the house. */
export const SMOKE_SHADER = `${SMOKE}
uniform vec4 lamp_at[${LAMPS}], lamp_intensity[${LAMPS}], lamp_cone[${LAMPS}], albedo, ambient;
uniform float lamp_inner[${LAMPS}];
uniform int lamp_list[${LAMPS}], lamp_count;

vec3 brume_light(vec3 position, vec3 texel, vec3 direction) {
  vec2 sky = brume_sky_at(texel);
  vec3 sum = vec3(0.0), on_ground = vec3(0.0);
  for (int k = 0; k < lamp_count; ++k) {
    int i = lamp_list[k];
    vec4 at = lamp_at[i], cone = lamp_cone[i];
    vec2 reach = brume_light_at(texel, i);
    if (reach.y <= 0.0) continue;
    vec3 to = at.w > 1.5 ? at.xyz : at.xyz - position;
    float square = dot(to, to);
    vec3 towards = to * inversesqrt(square);
    float falloff = at.w > 1.5 ? 1.0 : 1.0 / (square + 0.1); // lamps are no points
    if (at.w > 0.5 && at.w < 1.5) {
      float spot = clamp((dot(-towards, cone.xyz) - cone.w) / max(lamp_inner[i] - cone.w, 1e-4), 0.0, 1.0);
      falloff *= spot * spot;
    }
    vec3 arriving = lamp_intensity[i].rgb * falloff * reach.y;
    sum += arriving * brume_scattered(reach.x, dot(towards, direction), albedo.rgb, albedo.a, sky.x);
    if (at.w > 1.5) on_ground += arriving * max(towards.y, 0.0);
  }
  vec3 reflected = ambient.a * (ambient.rgb + on_ground / 3.14159265);
  return sum + brume_scattered_sky(sky, ambient.rgb, reflected, albedo.rgb, albedo.a);
}
${MARCH}`;

/** light_left_at(): what smoke leaves of the light at a surface. */
export const SURFACE_SHADER = `
uniform highp sampler3D light_left;
uniform vec3 light_origin, light_extent;
vec3 light_left_at(vec3 position) {
  vec3 at = (position - light_origin) / light_extent;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return vec3(1.0);
  return textureLod(light_left, at, 0.0).rgb;
}
`;
