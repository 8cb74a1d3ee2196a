// The page: a house at night, whose smoke the simulation moves; taps throw, shoot, write and blast.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Dummies } from './dummies.js';
import { DOORS, LEVEL, lampsOf, loadHouse } from './house.js';
import { Interface, showMessage, uncover } from './interface.js';
import { makeLetters } from './letters.js';
import { Quality } from './quality.js';
import { HERE, Simulation, THERE, TICKS_PER_SECOND } from './simulation.js';
import { makeNoise, Smoke } from './smoke.js';
import { View } from './view.js';

const MOST_TICKS_A_FRAME = 24, TAP_PIXELS = 7;
const EYE = [-6.0, 1.45, 11.4], TARGET = [-0.5, 2.7, -0.6];
const settings = new URLSearchParams(location.search);

class Page {
  static async open() {
    const canvas = document.getElementById('picture');
    const gl = canvas.getContext('webgl2', { antialias: false, alpha: false, powerPreference: 'high-performance' });
    if (!gl) throw new Error('This page draws with WebGL 2, which this browser does not have or has switched off.');
    if (!gl.getExtension('EXT_color_buffer_float') && !gl.getExtension('EXT_color_buffer_half_float'))
      throw new Error('This page draws into images of 16-bit floats, which this device does not have.');
    const renderer = new THREE.WebGLRenderer({ canvas, context: gl });
    const here = new URL('.', location.href);
    const [simulation, house] = await Promise.all([Simulation.load(here), loadHouse(new URL('scene.glb', here).href)]);
    return new Page(renderer, simulation, house);
  }

  constructor(renderer, simulation, house) {
    Object.assign(this, { renderer, simulation, house });
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = THREE.PCFShadowMap;
    renderer.shadowMap.autoUpdate = false;
    renderer.shadowMap.needsUpdate = true;
    renderer.info.autoReset = false;
    renderer.autoClear = false;
    this.letters = makeLetters();
    for (const mask of this.letters.masks) simulation.addMask(this.letters.texels, this.letters.texels, mask);
    simulation.create({ ...house.triangles, ...LEVEL });
    for (const lamp of lampsOf(house.lights)) simulation.addLight(lamp);

    const shared = { noise: makeNoise(), masks: this.letters.texture };
    this.smokes = [HERE, THERE].map(player => new Smoke(simulation, player, shared));
    this.views = this.smokes.map(smoke => new View(renderer, smoke));
    this.dummies = new Dummies(house.scene, document.getElementById('labels'));
    this.quality = new Quality(settings.get('quality'));
    this.face = new Interface(DOORS.map(door => door.name), {
      seek: tick => { this.isPlaying = false; this.goTo(tick); },
      setPlaying: isPlaying => { this.isPlaying = isPlaying; },
      toggleDoor: door => this.toggleDoor(door)
    });
    Object.assign(this, { tick: 0, exact: 0, latest: 0, isPlaying: settings.get('paused') === null, hasMoved: true });
    this.doorEvents = [];
    this.leaves = DOORS.map(() => 0);
    this.#listen();
    this.report = simulation.report();
    this.before = performance.now();
  }

  #listen() {
    const canvas = this.renderer.domElement, camera = this.views[HERE].camera;
    camera.position.set(...EYE);
    this.controls = new OrbitControls(camera, canvas);
    this.controls.target.set(...TARGET);
    Object.assign(this.controls, { enableDamping: true, dampingFactor: 0.12, minDistance: 2, maxDistance: 26,
                                   maxPolarAngle: 0.53 * Math.PI, rotateSpeed: 0.55, zoomToCursor: true });
    this.controls.addEventListener('change', () => { this.hasMoved = true; });
    this.controls.update();
    let down = null;
    canvas.addEventListener('pointerdown', event => { down = event.isPrimary ? [event.clientX, event.clientY] : null; });
    canvas.addEventListener('pointerup', event => {
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < TAP_PIXELS)
        this.act(event.clientX, event.clientY);
      down = null;
    });
    addEventListener('keydown', event => {
      if (event.target.matches('input:not([type=range])')) return;
      const tool = ['throw', 'shoot', 'word', 'blast']['1234'.indexOf(event.key)];
      if (tool) this.face.choose(tool);
      if (event.key === ' ') this.isPlaying = !this.isPlaying;
    });
  }

  // ---- What a tap does ----

  /** The ray through a point of the window, to the first surface: {eye, direction, distance, normal}. */
  aim(x, y) {
    const area = this.areas.find(area => x >= area.x && x < area.x + area.width) ?? this.areas[0];
    const at = new THREE.Vector2(2 * (x - area.x) / area.width - 1, 1 - 2 * (y - area.y) / area.height);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.views[HERE].camera);
    const hit = ray.intersectObject(this.house.root, true).find(found => found.object.visible);
    const normal = hit ? hit.face.normal.clone().transformDirection(hit.object.matrixWorld) : new THREE.Vector3();
    return { eye: ray.ray.origin, direction: ray.ray.direction, distance: Math.min(hit?.distance ?? 24, 24), normal };
  }

  /** Where a ray is well inside of smoke, or its end. */
  intoSmoke({ eye, direction, distance }) {
    for (let t = 0.5; t < distance; t += 0.5) {
      const at = eye.clone().addScaledVector(direction, t);
      if (this.simulation.depth(HERE, eye.toArray(), at.toArray()) > 1) return eye.clone().addScaledVector(direction, t + 0.7);
    }
    return eye.clone().addScaledVector(direction, distance - 0.4);
  }

  act(x, y) {
    const aim = this.aim(x, y), { eye, direction, distance, normal } = aim;
    const hit = eye.clone().addScaledVector(direction, distance).addScaledVector(normal, 0.3);
    const hand = eye.clone().add(new THREE.Vector3(0.2, -0.25, 0).applyQuaternion(this.views[HERE].camera.quaternion));
    const tools = {
      throw: () => this.simulation.throwSmoke(hand.toArray(), hit.toArray(), 260, 2.2),
      shoot: () => this.simulation.shoot(hand.toArray(), hit.addScaledVector(direction, 1).toArray(), 0.17, 1.6),
      word: () => this.#write(aim),
      blast: () => this.simulation.blast(this.intoSmoke(aim).toArray(), 3.2)
    };
    tools[this.face.tool]();
    this.isPlaying = true;
  }

  #write(aim) {
    const { eye, direction } = aim, depth = this.intoSmoke(aim).distanceTo(eye);
    const right = new THREE.Vector3().crossVectors(direction, new THREE.Vector3(0, 1, 0)).normalize();
    const letters = this.letters.layout(this.face.word);
    const widest = Math.max(3, 2 * Math.max(...letters.map(letter => Math.abs(letter.right))) + 1);
    const edge = Math.min(1.5, 0.62 * depth * Math.min(1, this.views[HERE].camera.aspect) / widest);
    for (const { mask, right: at } of letters) {
      const from = eye.clone().addScaledVector(right, edge * at);
      this.simulation.shoot(from.toArray(), from.clone().addScaledVector(direction, 30).toArray(), edge / 2, 6, mask);
    }
  }

  toggleDoor(door) {
    const solid = !this.#shutAt(this.tick + 1)[door];
    this.simulation.edit(DOORS[door].low, DOORS[door].high, solid);
    this.doorEvents.push({ tick: this.tick + 1, door, solid });
    this.doorEvents.sort((a, b) => a.tick - b.tick);
    this.isPlaying = true;
  }

  #shutAt(tick) {
    const shut = DOORS.map(() => false);
    for (const event of this.doorEvents) if (event.tick <= tick) shut[event.door] = event.solid;
    return shut;
  }

  // ---- Time ----

  /** Moves the match to a tick, backwards too. */
  goTo(tick) {
    if (tick === this.tick) return;
    this.simulation.goTo(tick, this.face.loss);
    this.report = this.simulation.report();
    this.tick = this.exact = tick;
    this.latest = Math.max(this.latest, tick);
    const shut = this.#shutAt(tick);
    if (shut.join() !== this.shut?.join()) this.simulation.restartLight();
    this.shut = shut;
  }

  #play(seconds) {
    if (!this.isPlaying) return;
    const exact = this.exact + Math.min(seconds * TICKS_PER_SECOND, MOST_TICKS_A_FRAME);
    this.goTo(Math.floor(exact));
    this.exact = exact;
  }

  /** Leaves of doors and grenades where they are now; true: something in the house has moved. */
  #moveThings(seconds) {
    let hasMoved = false;
    this.house.setDoors.forEach((set, i) => {
      const goal = this.shut?.[i] ? 1 : 0, t = this.leaves[i];
      if (t === goal) return;
      this.leaves[i] = goal > t ? Math.min(goal, t + 3 * seconds) : Math.max(goal, t - 3 * seconds);
      set(this.leaves[i]);
      hasMoved = this.renderer.shadowMap.needsUpdate = true;
    });
    const { grenade } = this.house, flying = this.report.flying;
    if (flying.length > 0 || grenade.visible) {
      grenade.visible = flying.length > 0;
      if (flying.length > 0) grenade.position.set(...flying.at(-1));
      hasMoved = true;
    }
    return hasMoved;
  }

  // ---- A frame ----

  #areas() {
    const width = innerWidth, height = innerHeight;
    if (!this.face.isSplit) return [{ x: 0, y: 0, width, height }];
    const half = Math.floor(width / 2);
    return [{ x: 0, y: 0, width: half - 1, height }, { x: half + 1, y: 0, width: width - half - 1, height }];
  }

  #resize() {
    const { step } = this.quality, ratio = Math.min(step.pixels, devicePixelRatio);
    this.areas = this.#areas();
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x !== innerWidth || size.y !== innerHeight || this.renderer.getPixelRatio() !== ratio) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(innerWidth, innerHeight, false);
      this.hasMoved = true;
    }
    this.areas.forEach((area, i) => {
      const { camera } = this.views[i], aspect = area.width / area.height;
      camera.fov = Math.min(82, Math.max(50, 360 / Math.PI * Math.atan(0.5 / aspect)));
      this.views[i].resize(Math.max(2, Math.round(area.width * ratio)), Math.max(2, Math.round(area.height * ratio)), step.scale, step.samples);
      this.views[i].smoke.uniforms.steps.value = step.steps;
    });
  }

  frame(now) {
    const seconds = THREE.MathUtils.clamp((now - this.before) / 1000, 0, 0.5);
    this.quality.note(Math.max(0, now - this.before));
    this.before = now;
    const begun = performance.now();
    this.#play(seconds);
    this.#resize();
    this.controls.update();
    let hasMoved = this.#moveThings(seconds) || this.hasMoved;
    let samples = 0, uploaded = 0;
    this.areas.forEach((_, i) => {
      this.smokes[i].update(this.renderer, this.tick / TICKS_PER_SECOND, this.quality.step.lines);
      samples += this.views[i].samples;
      uploaded += this.smokes[i].uploaded;
    });
    hasMoved = this.dummies.ask(this.simulation, HERE, this.face.asksDrawn) || hasMoved;
    const simulated = performance.now() - begun;
    this.areas.forEach((area, i) => {
      if (i > 0) {
        const { position, quaternion } = this.views[HERE].camera;
        this.views[i].camera.position.copy(position);
        this.views[i].camera.quaternion.copy(quaternion);
      }
      this.views[i].draw(this.house.scene, { ...area, y: innerHeight - area.y - area.height }, hasMoved);
    });
    this.hasMoved = false;
    this.dummies.place(this.views[HERE].camera, this.areas[0]);
    this.#show({ samples, uploaded, simulated });
  }

  #show(cost) {
    this.face.showTime(this.tick, this.latest, this.isPlaying);
    this.face.showDoors(this.shut ?? [false, false, false]);
    this.simulatedMean = (this.simulatedMean ?? cost.simulated) * 0.9 + 0.1 * cost.simulated;
    this.face.showMatch(this.report, this.dummies.answer);
    this.face.showCost({ ...cost, simulated: this.simulatedMean, frame: this.quality.milliseconds, quality: this.quality.step.name });
  }

  run() {
    this.frame(performance.now());
    uncover();
    this.renderer.setAnimationLoop(now => this.frame(now));
  }
}

try {
  window.page = await Page.open();
  window.page.run();
} catch (error) {
  showMessage(error.message, true);
  console.error(error);
}
