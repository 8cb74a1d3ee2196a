// The smoke in the picture: textures that follow what a player sees, and the shader's part that reads them. All that
// depends on how smoke gets to the renderer is here.
import * as THREE from 'three';
import { BRICK } from './simulation.js';
import { LEVEL } from './house.js';

const MOST_HOLES = 64;
const ALBEDO = [0.90, 0.91, 0.93], AMBIENT = [0.0075, 0.0115, 0.0210];

/** A texture of three dimensions that is filtered between texels. */
function volumeTexture(data, [x, y, z], format, type) {
  const texture = new THREE.Data3DTexture(data, x, y, z);
  Object.assign(texture, { format, type, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter, unpackAlignment: 1 });
  texture.needsUpdate = true;
  return texture;
}

/** Cells of noise, repeating: 0 at feature points. */
export function makeNoise(size = 48) {
  const data = new Uint8Array(size ** 3);
  let seed = 7;
  const random = () => ((seed = (seed * 1664525 + 1013904223) >>> 0) / 4294967296);
  const octaves = [4, 8, 16].map(cells => ({ cells, points: Array.from({ length: cells ** 3 }, () => [random(), random(), random()]) }));
  for (let z = 0, at = 0; z < size; ++z)
    for (let y = 0; y < size; ++y)
      for (let x = 0; x < size; ++x, ++at) {
        let sum = 0, weight = 0.57;
        for (const { cells, points } of octaves) {
          const p = [x, y, z].map(c => (c + 0.5) / size * cells), base = p.map(Math.floor);
          let nearest = 9;
          for (let i = 0; i < 27; ++i) {
            const c = [base[0] + i % 3 - 1, base[1] + Math.floor(i / 3) % 3 - 1, base[2] + Math.floor(i / 9) - 1];
            const w = c.map(v => (v + cells) % cells), q = points[w[0] + cells * (w[1] + cells * w[2])];
            nearest = Math.min(nearest, (c[0] + q[0] - p[0]) ** 2 + (c[1] + q[1] - p[1]) ** 2 + (c[2] + q[2] - p[2]) ** 2);
          }
          sum += weight * (1 - Math.min(1, Math.sqrt(nearest)));
          weight *= 0.5;
        }
        data[at] = Math.min(255, 255 * sum);
      }
  const texture = volumeTexture(data, [size, size, size], THREE.RedFormat, THREE.UnsignedByteType);
  texture.wrapS = texture.wrapT = texture.wrapR = THREE.RepeatWrapping;
  return texture;
}

export class Smoke {
  /** `shared`: textures of masks and noise, that all players' smoke has in common. */
  constructor(simulation, player, shared) {
    Object.assign(this, { simulation, player });
    const size = LEVEL.size.map(n => BRICK * Math.ceil(n / BRICK));
    this.density = volumeTexture(new Uint8Array(size[0] * size[1] * size[2]), size, THREE.RedFormat, THREE.UnsignedByteType);
    this.holes = new THREE.DataTexture(new Float32Array(12 * MOST_HOLES), 3, MOST_HOLES, THREE.RGBAFormat, THREE.FloatType);
    const lightSize = LEVEL.size.map(n => Math.ceil(n / 2)), cells = lightSize[0] * lightSize[1] * lightSize[2];
    this.light = volumeTexture(new Uint16Array(4 * cells), lightSize, THREE.RGBAFormat, THREE.HalfFloatType);
    this.dim = volumeTexture(new Uint8Array(4 * cells).fill(255), lightSize, THREE.RGBAFormat, THREE.UnsignedByteType);
    this.time = 0;
    this.uploaded = 0;
    this.uniforms = {
      density: { value: this.density }, holes: { value: this.holes }, hole_count: { value: 0 },
      noise: { value: shared.noise }, masks: { value: shared.masks }, smoke_time: { value: 0 },
      light: { value: this.light }, dim: { value: this.dim },
      origin: { value: new THREE.Vector3(...LEVEL.origin) },
      extent: { value: new THREE.Vector3(...size).multiplyScalar(LEVEL.voxel) },
      light_extent: { value: new THREE.Vector3(...lightSize).multiplyScalar(2 * LEVEL.voxel) },
      voxel: { value: LEVEL.voxel }, extinction: { value: 7 }, steps: { value: 48 },
      albedo: { value: new THREE.Vector3(...ALBEDO) }, ambient: { value: new THREE.Vector3(...AMBIENT) }
    };
    this.block = new THREE.Data3DTexture(new Uint8Array(BRICK ** 3), BRICK, BRICK, BRICK);
  }

  /** Uploads what has changed. `lines`: of sight that the light may take. */
  update(renderer, seconds, lines) {
    this.uploaded = 0;
    this.#updateDensity(renderer);
    const { count, numbers } = this.simulation.holes(this.player);
    this.holes.image.data.set(numbers.subarray(0, 12 * MOST_HOLES));
    this.holes.needsUpdate = count > 0;
    this.uniforms.hole_count.value = Math.min(count, MOST_HOLES);
    this.uniforms.smoke_time.value = seconds;
    this.uploaded += count > 0 ? 48 * MOST_HOLES : 0;
    if (lines > 0) this.#updateLight(lines);
  }

  #updateDensity(renderer) {
    const { count, places, densities } = this.simulation.update(this.player);
    if (count === 0) return;
    const gl = renderer.getContext(), properties = renderer.properties.get(this.density);
    if (!properties.__webglTexture) renderer.initTexture(this.density);
    renderer.state.activeTexture(gl.TEXTURE0);
    renderer.state.bindTexture(gl.TEXTURE_3D, renderer.properties.get(this.density).__webglTexture);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    for (let i = 0; i < count; ++i)
      gl.texSubImage3D(gl.TEXTURE_3D, 0, BRICK * places[3 * i], BRICK * places[3 * i + 1], BRICK * places[3 * i + 2],
                       BRICK, BRICK, BRICK, gl.RED, gl.UNSIGNED_BYTE, densities, 512 * i);
    renderer.state.unbindTexture();
    this.uploaded += 512 * count;
  }

  #updateLight(lines) {
    const { texels, dims } = this.simulation.light(this.player, lines);
    this.light.image.data.set(texels);
    this.dim.image.data.set(dims);
    this.light.needsUpdate = this.dim.needsUpdate = true;
    this.uploaded += texels.byteLength + dims.byteLength;
  }
}

/** brume_march() and brume_light(): what of smoke.glsl the picture calls, and how much light is left at a surface. */
export const SMOKE_SHADER = `
uniform highp sampler3D density, noise, light, dim;
uniform highp sampler2D holes, masks;
uniform int hole_count;
uniform vec3 origin, extent, light_extent, albedo, ambient;
uniform float voxel, extinction, smoke_time;
uniform int steps;

vec3 brume_light(vec3 position, vec3 texel, vec3 direction) {
  vec4 arriving = textureLod(light, (position - origin) / light_extent, 0.0);
  return albedo * (0.19 * arriving.rgb + 1.6 * ambient * arriving.a);
}

float hole_left(int hole, vec3 p) {
  vec4 a = texelFetch(holes, ivec2(0, hole), 0), b = texelFetch(holes, ivec2(1, hole), 0), c = texelFetch(holes, ivec2(2, hole), 0);
  vec3 from = p - a.xyz;
  float z = dot(from, b.xyz);
  if (z < 0.0 || z > b.w) return 1.0;
  float age = c.x - 0.25 * z / max(b.w, 0.1);
  float closing = 1.0 - clamp((age - 0.05 - c.y) / 0.6, 0.0, 1.0);
  float radius = a.w * clamp(age / 0.05, 0.0, 1.0) * closing;
  vec3 across = from - z * b.xyz;
  if (radius <= 0.0) return 1.0;
  if (c.z < 0.0) return 1.0 - closing * smoothstep(radius, 0.6 * radius, length(across));
  vec3 right = normalize(cross(b.xyz, vec3(0.0, 1.0, 0.0))), up = cross(right, b.xyz);
  vec2 uv = vec2(dot(across, right), dot(across, up)) / radius;
  if (max(abs(uv.x), abs(uv.y)) >= 1.0) return 1.0;
  uv = 0.5 + 0.5 * uv;
  return 1.0 - closing * textureLod(masks, vec2((uv.x + mod(c.z, 8.0)) / 8.0, (uv.y + 7.0 - floor(c.z / 8.0)) / 8.0), 0.0).r;
}

float density_at(vec3 p, float pixel) {
  vec3 uvw = (p - origin) / extent;
  float d = textureLod(density, uvw, 0.0).r;
  if (d <= 0.004) return 0.0;
  vec3 q = p + 0.2 * vec3(sin(smoke_time * 0.23 + p.z), -0.6 * smoke_time, cos(smoke_time * 0.19 + p.x));
  float n = 0.68 * textureLod(noise, q / 3.2, 0.0).r + 0.32 * textureLod(noise, q / 0.83, 0.0).r;
  float threshold = 0.8 * (1.0 - 1.5 * n);
  d = clamp(3.0 * (d - threshold) / max(1.0 - threshold, 0.05), 0.0, 1.0);
  for (int hole = 0; hole < hole_count && d > 0.0; ++hole) d *= hole_left(hole, p);
  return d;
}

vec4 brume_march(vec3 eye, vec3 direction, float t_end, float jitter, float pixel_width) {
  vec3 safe = direction + vec3(lessThan(abs(direction), vec3(1e-5))) * 1e-5;
  vec3 a = (origin - eye) / safe, b = (origin + extent - eye) / safe, low = min(a, b), high = max(a, b);
  float t = max(max(low.x, low.y), max(low.z, 0.0)), end = min(min(high.x, high.y), min(high.z, t_end));
  vec4 gathered = vec4(0.0, 0.0, 0.0, 1.0);
  float ds = max((end - t) / float(steps), 0.08);
  for (t += jitter * ds; t < end; t += ds) {
    vec3 p = eye + t * direction;
    float d = density_at(p, t * pixel_width);
    if (d <= 0.0) continue;
    float passed = exp(-extinction * d * ds);
    gathered.rgb += gathered.a * (1.0 - passed) * brume_light(p, vec3(0.0), direction);
    gathered.a *= passed;
    if (gathered.a < 0.004) return vec4(gathered.rgb, 0.0);
  }
  return gathered;
}

vec3 light_left(vec3 position) {
  vec3 uvw = (position - origin) / light_extent;
  if (any(lessThan(uvw, vec3(0.0))) || any(greaterThan(uvw, vec3(1.0)))) return vec3(1.0);
  return textureLod(dim, uvw, 0.0).rgb;
}
`;
