// The module of the simulation: its functions with arrays of JavaScript. Every failure is an Error with its reason.
import createModule from './brume_web.js';

export const HERE = 0,
  THERE = 1;
export const TICKS_PER_SECOND = 64;
const TEXTURES = 11; // BRUME_TEXTURE_COUNT

export class Simulation {
  static async load(url) {
    return new Simulation(await createModule({ locateFile: name => new URL(name, url).href }));
  }

  constructor(module) {
    this.module = module;
    this.scratch = module._malloc(256);
  }

  #checked(result) {
    if (result !== 0) throw new Error(this.module.UTF8ToString(this.module._web_error()) || `error ${result}`);
  }

  /** Puts numbers where the module reads them, for one call. */
  #points(...points) {
    const at = this.scratch >> 2;
    points.forEach((point, i) => this.module.HEAPF32.set(point, at + 4 * i));
    return points.map((_, i) => this.scratch + 16 * i);
  }

  #kept(array) {
    const at = this.module._malloc(array.byteLength);
    this.module.HEAPU8.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), at);
    return at;
  }

  addMask(width, height, texels) {
    this.#checked(this.module._web_add_mask(width, height, this.#kept(texels)));
  }

  /** `level`: {points, indices} of its triangles, and {origin, voxel, size} of its voxels. */
  create({ points, indices, origin, voxel, size }) {
    const kept = [points, indices, new Float32Array(origin), new Int32Array(size)].map(array => this.#kept(array));
    this.#checked(
      this.module._web_create(kept[0], points.length / 3, kept[1], indices.length, kept[2], voxel, kept[3])
    );
    kept.forEach(at => this.module._free(at));
  }

  throwSmoke(from, at, cubicMetres, bloom) {
    this.#checked(this.module._web_throw(...this.#points(from, at), cubicMetres, bloom));
  }

  shoot(from, toward, radius, stay, mask = -1) {
    this.#checked(this.module._web_shoot(...this.#points(from, toward), radius, stay, mask));
  }

  blast(at, radius) {
    this.#checked(this.module._web_blast(...this.#points(at), radius));
  }

  edit(low, high, solid) {
    const at = this.scratch >> 2;
    this.module.HEAP32.set([...low, 0, ...high], at);
    this.#checked(this.module._web_edit(this.scratch, this.scratch + 16, solid ? 1 : 0));
  }

  clear() {
    this.#checked(this.module._web_clear());
  }

  goTo(tick, loss) {
    this.#checked(this.module._web_go_to(tick, loss));
  }

  /** Ticks, hashes and counts: web_report of brume_web.h. */
  report() {
    const at = this.module._web_report_of() >> 2,
      words = this.module.HEAPU32;
    const wide = (low, high) =>
      words[at + high].toString(16).padStart(8, '0') + words[at + low].toString(16).padStart(8, '0');
    const [packets, lost, answers, bytes, clouds, holes, blasts, grenades] = words.subarray(at + 8, at + 16);
    const flying = [];
    for (let i = 0; i < grenades; ++i)
      flying.push([...this.module.HEAPF32.subarray(at + 16 + 3 * i, at + 19 + 3 * i)]);
    return {
      ticks: [words[at], words[at + 1]],
      hashes: [wide(2, 4), wide(3, 5)],
      serverThen: wide(6, 7),
      packets,
      lost,
      answers,
      bytes,
      clouds,
      holes,
      blasts,
      flying
    };
  }

  addTextureLight(at, isDirectional) {
    this.#checked(this.module._web_add_texture_light(...this.#points(at), isDirectional ? 1 : 0));
  }

  /** The next updates hand out all textures again, whole. */
  renew() {
    this.module._web_renew();
  }

  /**
   * Takes over what a player sees, at a time: {textures, regions, constants}, valid until the next call. `textures`:
   * {format, width, height, depth, generation} each; `regions`: {texture, x, y, z, width, height, depth, texels}.
   */
  update(player, seconds, lightFraction) {
    const { module } = this;
    this.#checked(module._web_update(player, seconds, lightFraction));
    const words = module.HEAPU32,
      list = module._web_texture_list() >> 2,
      regions = module._web_regions() >> 2;
    const textures = Array.from({ length: TEXTURES }, (_, i) => {
      const [format, width, height, depth, generation] = words.subarray(list + 5 * i, list + 5 * i + 5);
      return { format, width, height, depth, generation };
    });
    const constants = module._web_constants() >> 2;
    return {
      textures,
      constants: module.HEAPF32.subarray(constants, constants + 40),
      regions: Array.from({ length: module._web_region_count() }, (_, i) => {
        const [texture, x, y, z, width, height, depth, , at, bytes] = words.subarray(
          regions + 10 * i,
          regions + 10 * i + 10
        );
        return { texture, x, y, z, width, height, depth, at, bytes };
      })
    };
  }

  depth(player, a, b) {
    return this.module._web_depth(player, ...this.#points(a, b));
  }

  /** 'sees', 'smoke' or 'wall': what is between two points. */
  sees(player, a, b, drawn) {
    const answer = this.module._web_sees(player, ...this.#points(a, b), drawn ? 1 : 0);
    if (answer < 0) this.#checked(answer);
    return ['smoke', 'sees', 'wall'][answer];
  }

  addLight({ position, towards, color: given, direction = [0, -1, 0], inner = -2, outer = -2 }) {
    const square = position.reduce((sum, p) => sum + p * p, 0),
      color = given.map(c => (towards ? c * square : c));
    this.#checked(this.module._web_add_light(...this.#points(position, color, direction), inner, outer));
  }

  /** Goes on with what smoke leaves of the light at surfaces: the texels of all cells. */
  light(player, lines) {
    const changed = this.module._web_light(player, lines);
    if (changed < 0) this.#checked(changed);
    const size = this.lightSize(),
      at = this.module._web_light_texels(player);
    return this.module.HEAPU8.subarray(at, at + 4 * size[0] * size[1] * size[2]);
  }

  lightSize() {
    const at = this.module._web_light_size() >> 2;
    return [...this.module.HEAP32.subarray(at, at + 3)];
  }

  restartLight() {
    this.module._web_light_restart();
  }
}
