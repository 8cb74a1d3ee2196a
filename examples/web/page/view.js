// A player's picture: the house in half floats with its depth, the smoke at a lower resolution, both joined, bloom
// and tone.
import * as THREE from 'three';
import { SMOKE_SHADER, SURFACE_SHADER } from './smoke.js';

const VERTEX =
  'out vec2 uv; void main() { uv = position.xy * 0.5 + 0.5; gl_Position = vec4(position.xy, 0.0, 1.0); }';
const EXPOSURE = 3.7; // 2^1.9, of scenes/demo.toml

const HEAD = `precision highp float;
precision highp int;
in vec2 uv;
out vec4 color;
uniform sampler2D depth_map;
uniform mat4 to_world;
uniform vec3 eye;
vec3 world_at(vec2 at, float depth) {
  vec4 p = to_world * vec4(2.0 * vec3(at, depth) - 1.0, 1.0);
  return p.xyz / p.w;
}
float jitter_of(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }
`;

const MARCH = `${HEAD}${SMOKE_SHADER}
uniform float pixel_width;
void main() {
  vec3 surface = world_at(uv, textureLod(depth_map, uv, 0.0).r);
  float distance_to_surface = length(surface - eye);
  vec3 direction = (surface - eye) / distance_to_surface;
  color = brume_march(eye, direction, distance_to_surface, jitter_of(gl_FragCoord.xy), pixel_width);
}`;

// Smoke between its own pixels: those whose surface is as far as this pixel's count most.
const JOIN = `${HEAD}${SURFACE_SHADER}
uniform sampler2D opaque, smoke_map;
uniform vec2 planes;
float metres(float depth) { return planes.x * planes.y / (planes.y - depth * (planes.y - planes.x)); }
void main() {
  float depth = textureLod(depth_map, uv, 0.0).r, here = metres(depth);
  vec2 size = vec2(textureSize(smoke_map, 0)), base = floor(uv * size - 0.5);
  vec4 sum = vec4(0.0);
  float weight = 0.0;
  for (int y = -1; y < 3; ++y)
    for (int x = -1; x < 3; ++x) {
      vec2 texel = base + vec2(x, y), at = (texel + 0.5) / size;
      vec2 apart = abs(uv * size - 0.5 - texel);
      float there = metres(textureLod(depth_map, at, 0.0).r);
      float w = exp(-0.9 * dot(apart, apart)) / (1e-3 + abs(there - here) / here);
      sum += w * textureLod(smoke_map, at, 0.0);
      weight += w;
    }
  vec4 smoke = sum / weight;
  vec3 behind = textureLod(opaque, uv, 0.0).rgb;
  if (depth < 1.0) {
    vec3 surface = world_at(uv, depth);
    vec3 left = light_left_at(surface + 0.3 * normalize(eye - surface));
    float glows = clamp(0.25 * max(behind.r, max(behind.g, behind.b)) - 1.0, 0.0, 1.0);
    behind *= mix(left, vec3(1.0), glows);
  }
  color = vec4(smoke.rgb + smoke.a * behind, 1.0);
}`;

const SHRINK = `precision highp float; in vec2 uv; out vec4 color; uniform sampler2D source; uniform float first;
void main() {
  vec2 texel = 1.0 / vec2(textureSize(source, 0));
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    vec3 c = textureLod(source, uv + texel * vec2(i & 1, i >> 1) * 2.0 - texel, 0.0).rgb;
    sum += first > 0.5 ? c / (1.0 + 0.25 * max(c.r, max(c.g, c.b))) : c;
  }
  color = vec4(0.25 * sum, 1.0);
}`;

const GROW = `precision highp float; in vec2 uv; out vec4 color; uniform sampler2D source, smaller; uniform float share;
void main() {
  vec2 texel = 1.0 / vec2(textureSize(smaller, 0));
  vec3 sum = vec3(0.0);
  for (int y = -1; y < 2; ++y)
    for (int x = -1; x < 2; ++x)
      sum += textureLod(smaller, uv + texel * vec2(x, y), 0.0).rgb * float((2 - abs(x)) * (2 - abs(y))) / 16.0;
  color = vec4(mix(textureLod(source, uv, 0.0).rgb, sum, share), 1.0);
}`;

const SHOW = `precision highp float; in vec2 uv; out vec4 color; uniform sampler2D source, glow; uniform float exposure;
vec3 tone(vec3 x) {  // Hill's fit of the ACES curves
  x = mat3(0.59719, 0.076, 0.0284, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777) * x;
  x = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
  x = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602) * x;
  return clamp(x, 0.0, 1.0);
}
void main() {
  vec3 x = textureLod(source, uv, 0.0).rgb;
  x = mix(x, textureLod(glow, uv, 0.0).rgb, 0.07) * exposure;
  vec2 from = uv - 0.5;
  x = tone(x * (1.0 - 0.45 * dot(from, from)));
  x = mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
  float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
  color = vec4(x + grain / 255.0, 1.0);
}`;

const LEVELS = 5;

function pass(fragmentShader, uniforms) {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: `in vec3 position; ${VERTEX}`,
    fragmentShader,
    uniforms,
    depthTest: false,
    depthWrite: false
  });
}

function halfTarget(filter = THREE.LinearFilter) {
  return new THREE.WebGLRenderTarget(1, 1, {
    type: THREE.HalfFloatType,
    minFilter: filter,
    magFilter: filter,
    depthBuffer: false
  });
}

export class View {
  constructor(renderer, smoke) {
    Object.assign(this, { renderer, smoke });
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.1, 400);
    this.opaque = new THREE.WebGLRenderTarget(1, 1, { type: THREE.HalfFloatType, samples: 4 });
    this.opaque.depthTexture = new THREE.DepthTexture(1, 1, THREE.UnsignedIntType);
    this.march = halfTarget();
    this.joined = halfTarget();
    this.glows = Array.from({ length: LEVELS }, () => halfTarget());
    this.grown = Array.from({ length: LEVELS - 1 }, () => halfTarget());
    this.frame = {
      depth_map: { value: this.opaque.depthTexture },
      to_world: { value: new THREE.Matrix4() },
      eye: { value: new THREE.Vector3() }
    };
    this.marching = pass(MARCH, { ...smoke.uniforms, ...this.frame, pixel_width: { value: 0.001 } });
    this.joining = pass(JOIN, {
      ...smoke.uniforms,
      ...this.frame,
      opaque: { value: this.opaque.texture },
      smoke_map: { value: this.march.texture },
      planes: { value: new THREE.Vector2(0.1, 400) }
    });
    this.shrinking = pass(SHRINK, { source: { value: null }, first: { value: 0 } });
    this.growing = pass(GROW, { source: { value: null }, smaller: { value: null }, share: { value: 0.62 } });
    this.showing = pass(SHOW, {
      source: { value: this.joined.texture },
      glow: { value: this.grown[0].texture },
      exposure: { value: EXPOSURE }
    });
    this.triangle = new THREE.Mesh(new THREE.BufferGeometry(), this.marching);
    this.triangle.geometry.setAttribute(
      'position',
      new THREE.Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3)
    );
    this.triangle.frustumCulled = false;
    this.plain = new THREE.Scene().add(this.triangle);
    this.flat = new THREE.Camera();
    this.isStale = true;
  }

  /** Pixels of the picture, and the scale of the smoke in it. */
  resize(width, height, scale, samples) {
    const key = [width, height, scale, samples].join();
    if (key === this.key) return;
    this.key = key;
    if (this.opaque.samples !== samples) {
      this.opaque.dispose();
      this.opaque.samples = samples;
    }
    this.opaque.setSize(width, height);
    this.joined.setSize(width, height);
    this.march.setSize(Math.ceil(width * scale), Math.ceil(height * scale));
    this.glows.forEach((target, i) =>
      target.setSize(Math.max(1, width >> (i + 1)), Math.max(1, height >> (i + 1)))
    );
    this.grown.forEach((target, i) => target.setSize(this.glows[i].width, this.glows[i].height));
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.isStale = true;
  }

  /** The device has lost the picture. */
  forget() {
    this.isStale = true;
  }

  #draw(material, target) {
    this.triangle.material = material;
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.plain, this.flat);
  }

  /** Draws into a part of the canvas; the house only if it or the camera has changed. */
  draw(scene, area, hasMoved) {
    const { renderer, camera } = this;
    if (hasMoved || this.isStale) {
      renderer.setRenderTarget(this.opaque);
      renderer.clear();
      renderer.render(scene, camera);
      this.isStale = false;
    }
    camera.updateMatrixWorld();
    this.frame.to_world.value.multiplyMatrices(camera.matrixWorld, camera.projectionMatrixInverse);
    this.frame.eye.value.setFromMatrixPosition(camera.matrixWorld);
    this.marching.uniforms.pixel_width.value = (2 * Math.tan((camera.fov * Math.PI) / 360)) / this.march.height;
    if (this.smoke.isThere) {
      this.#draw(this.marching, this.march);
    } else {
      renderer.setRenderTarget(this.march);
      renderer.setClearColor(0x000000, 1);
      renderer.clear();
    }
    this.#draw(this.joining, this.joined);
    this.#glow();
    renderer.setRenderTarget(null);
    renderer.setViewport(area.x, area.y, area.width, area.height);
    renderer.setScissor(area.x, area.y, area.width, area.height);
    renderer.setScissorTest(true);
    this.triangle.material = this.showing;
    renderer.render(this.plain, this.flat);
    renderer.setScissorTest(false);
  }

  #glow() {
    let source = this.joined;
    this.glows.forEach((target, i) => {
      this.shrinking.uniforms.source.value = source.texture;
      this.shrinking.uniforms.first.value = i === 0 ? 1 : 0;
      this.#draw(this.shrinking, target);
      source = target;
    });
    for (let i = LEVELS - 2; i >= 0; --i) {
      this.growing.uniforms.source.value = this.glows[i].texture;
      this.growing.uniforms.smaller.value = source.texture;
      this.#draw(this.growing, this.grown[i]);
      source = this.grown[i];
    }
  }

  /** Samples of the march at most. */
  get samples() {
    return this.march.width * this.march.height * this.smoke.samplesOfRay;
  }

  dispose() {
    [this.opaque, this.march, this.joined, ...this.glows, ...this.grown].forEach(target => target.dispose());
  }
}
