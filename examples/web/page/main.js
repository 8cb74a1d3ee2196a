// The page: a house at night, whose smoke the simulation moves; taps throw, shoot, write and blast.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Dummies } from './dummies.js';
import { lampsOf, loadHouse } from './house.js';
import { Interface, showMessage, uncover } from './interface.js';
import { makeLetters } from './letters.js';
import { DOORS } from './level.js';
import { Match } from './match.js';
import { Opening } from './opening.js';
import { Quality } from './quality.js';
import { HERE, THERE } from './simulation.js';
import { Smoke } from './smoke.js';
import { View } from './view.js';

const TAP_PIXELS = 7;
const EYE = [-5.7, 1.4, 10.2],
  TARGET = [-0.75, 2.55, -0.6];
const OPENING_WORD = { text: 'BRUME', eye: [-5.7, 1.5, 10.2], at: [-2.9, 1.2, 2.3] };
const settings = new URLSearchParams(location.search);

const isIn = (area, x, y) =>
  x >= area.x && x < area.x + area.width && y >= area.y && y < area.y + area.height;

function makeRenderer() {
  const canvas = document.getElementById('picture');
  const gl = canvas.getContext('webgl2', { antialias: false, alpha: false, powerPreference: 'high-performance' });
  if (!gl) throw new Error('This page draws with WebGL 2, which this browser does not have or has switched off.');
  if (!gl.getExtension('EXT_color_buffer_float') && !gl.getExtension('EXT_color_buffer_half_float'))
    throw new Error('This page draws into images of 16-bit floats, which this device does not have.');
  const renderer = new THREE.WebGLRenderer({ canvas, context: gl });
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  renderer.shadowMap.autoUpdate = false; // the house stands still, but for its doors
  renderer.shadowMap.needsUpdate = true;
  renderer.autoClear = false;
  return renderer;
}

class Page {
  static async open() {
    const renderer = makeRenderer(),
      here = new URL('.', location.href).href;
    const house = await loadHouse(new URL('scene.glb', here).href);
    const page = new Page(renderer, house),
      letters = makeLetters();
    page.letters = letters;
    page.match = await Match.begin(
      { url: here, masks: letters.masks, texels: letters.texels, triangles: house.triangles, lamps: page.lamps },
      reply => page.#take(reply),
      message => showMessage(message, true)
    );
    page.begin();
    page.match.isPlaying = settings.get('paused') === null;
    return page;
  }

  constructor(renderer, house) {
    Object.assign(this, { renderer, house, lamps: lampsOf(house.lights), hasMoved: true, simulated: 0 });
    this.smokes = [HERE, THERE].map(() => new Smoke(renderer, this.lamps));
    this.views = this.smokes.map(smoke => new View(renderer, smoke));
    this.dummies = new Dummies(house.scene, document.getElementById('labels'));
    this.quality = new Quality(settings.get('quality'));
    this.face = new Interface(
      DOORS.map(door => door.name),
      {
        seek: tick => {
          this.#touch();
          this.match.seek(tick);
        },
        restart: () => {
          this.begin(this.match.restart());
        },
        setPlaying: isPlaying => {
          this.match.isPlaying = isPlaying;
        },
        toggleDoor: door => {
          this.#touch();
          this.match.act({ kind: 'door', door });
        }
      }
    );
    this.leaves = DOORS.map(() => 0);
    this.#listen();
    this.before = performance.now();
  }

  /** The match as it opens, unless the address asks for none. */
  begin(clears = 0) {
    if (settings.get('empty') !== null) return;
    const { text, eye, at } = OPENING_WORD;
    const direction = new THREE.Vector3(...at).sub(new THREE.Vector3(...eye));
    const distance = direction.length();
    this.opening = new Opening(clears, this.#word(text, new THREE.Vector3(...eye), direction.normalize(), distance));
    this.opening.due(0).forEach(action => this.match.act(action));
  }

  /** The visitor takes over. */
  #touch() {
    if (this.opening) this.face.invite();
    this.opening = null;
  }

  /** Takes an answer of the worker. */
  #take({ seen, sight, milliseconds, renewals }) {
    if (renewals !== this.match.renewals) return; // of textures that are lost
    for (const part of seen) this.smokes[part.player].follow(part);
    this.hasMoved = this.dummies.hear(sight) || this.hasMoved;
    this.simulated += 0.2 * (milliseconds - this.simulated);
    this.answers = (this.answers ?? 0) + 1;
  }

  /** Puts the camera where it begins, or elsewhere. */
  lookFrom(eye = EYE, target = TARGET) {
    this.views[HERE].camera.position.set(...eye);
    this.controls.target.set(...target);
    this.controls.update();
    this.hasMoved = true;
  }

  #listen() {
    const canvas = this.renderer.domElement,
      camera = this.views[HERE].camera;
    this.controls = new OrbitControls(camera, canvas);
    Object.assign(this.controls, {
      enableDamping: true,
      dampingFactor: 0.12,
      minDistance: 2,
      maxDistance: 26,
      maxPolarAngle: 0.53 * Math.PI,
      rotateSpeed: 0.55,
      zoomToCursor: true
    });
    this.controls.addEventListener('change', () => {
      this.hasMoved = true;
    });
    this.lookFrom();
    let down = null;
    canvas.addEventListener('pointerdown', event => {
      down = event.isPrimary ? [event.clientX, event.clientY] : null;
    });
    canvas.addEventListener('pointerup', event => {
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < TAP_PIXELS)
        this.act(event.clientX, event.clientY);
      down = null;
    });
    // What the device has lost is made again; a hidden page's time does not count as a slow frame.
    canvas.addEventListener('webglcontextlost', event => {
      event.preventDefault();
      this.isLost = true;
      showMessage('The picture is lost, and comes back when the device does.', true);
    });
    canvas.addEventListener('webglcontextrestored', () => {
      this.isLost = false;
      this.smokes.forEach(smoke => smoke.forget());
      this.views.forEach(view => view.forget());
      this.renderer.shadowMap.needsUpdate = true;
      this.match.renew();
      uncover();
    });
    document.addEventListener('visibilitychange', () => {
      this.before = performance.now();
    });
    addEventListener('keydown', event => {
      if (event.target.matches('input:not([type=range])')) return;
      const tool = ['throw', 'shoot', 'word', 'blast']['1234'.indexOf(event.key)];
      if (tool) this.face.choose(tool);
      if (event.key === ' ') this.match.isPlaying = !this.match.isPlaying;
    });
  }

  // ---- What a tap does ----

  /** The ray through a point of the window, to the first surface: {eye, direction, distance, normal}. */
  aim(x, y) {
    const area = this.areas.find(area => isIn(area, x, y)) ?? this.areas[0];
    const at = new THREE.Vector2((2 * (x - area.x)) / area.width - 1, 1 - (2 * (y - area.y)) / area.height);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.views[HERE].camera);
    const hit = ray.intersectObject(this.house.root, true).find(found => found.object.visible);
    const normal = hit ? hit.face.normal.clone().transformDirection(hit.object.matrixWorld) : new THREE.Vector3();
    return {
      eye: ray.ray.origin,
      direction: ray.ray.direction,
      distance: Math.min(hit?.distance ?? 24, 24),
      normal
    };
  }

  /** The action that shoots a word along a ray. */
  #word(text, eye, direction, distance) {
    const right = new THREE.Vector3().crossVectors(direction, new THREE.Vector3(0, 1, 0)).normalize();
    return {
      kind: 'word',
      ray: { eye: eye.toArray(), direction: direction.toArray(), distance },
      right: right.toArray(),
      letters: this.letters.layout(text),
      share: 0.62 * Math.min(1, this.views[HERE].camera.aspect)
    };
  }

  act(x, y) {
    const { eye, direction, distance, normal } = this.aim(x, y),
      { camera } = this.views[HERE];
    const ray = { eye: eye.toArray(), direction: direction.toArray(), distance };
    const at = eye.clone().addScaledVector(direction, distance).addScaledVector(normal, 0.3);
    const from = eye.clone().add(new THREE.Vector3(0.2, -0.25, 0).applyQuaternion(camera.quaternion));
    const through = at.clone().addScaledVector(direction, 1);
    const actions = {
      throw: { from: from.toArray(), at: at.toArray() },
      shoot: { from: from.toArray(), at: through.toArray() },
      word: this.#word(this.face.word, eye, direction, distance),
      blast: { ray }
    };
    this.#touch();
    this.face.showTap(x, y);
    this.match.act({ kind: this.face.tool, ...actions[this.face.tool] });
  }

  // ---- A frame ----

  /** Leaves of doors and grenades where they are now; true: something in the house has moved. */
  #moveThings(seconds) {
    let hasMoved = false;
    this.house.setDoors.forEach((set, i) => {
      const goal = this.match.shut[i] ? 1 : 0,
        t = this.leaves[i];
      if (t === goal) return;
      this.leaves[i] = goal > t ? Math.min(goal, t + 3 * seconds) : Math.max(goal, t - 3 * seconds);
      set(this.leaves[i]);
      hasMoved = this.renderer.shadowMap.needsUpdate = true;
    });
    const { grenade } = this.house,
      flying = this.match.report?.flying ?? [];
    if (flying.length > 0 || grenade.visible) {
      grenade.visible = flying.length > 0;
      if (flying.length > 0) grenade.position.set(...flying.at(-1));
      hasMoved = true;
    }
    return hasMoved;
  }

  #areas() {
    const width = innerWidth,
      height = innerHeight;
    if (!this.face.isSplit) return [{ x: 0, y: 0, width, height }];
    if (height > width) {
      const half = Math.floor(height / 2);
      return [
        { x: 0, y: 0, width, height: half - 1 },
        { x: 0, y: half + 1, width, height: height - half - 1 }
      ];
    }
    const half = Math.floor(width / 2);
    return [
      { x: 0, y: 0, width: half - 1, height },
      { x: half + 1, y: 0, width: width - half - 1, height }
    ];
  }

  #resize() {
    const { step } = this.quality,
      ratio = Math.min(step.pixels, devicePixelRatio);
    this.areas = this.#areas();
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x !== innerWidth || size.y !== innerHeight || this.renderer.getPixelRatio() !== ratio) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(innerWidth, innerHeight, false);
      this.hasMoved = true;
    }
    this.areas.forEach((area, i) => {
      const { camera } = this.views[i],
        aspect = area.width / area.height;
      camera.fov = Math.min(82, Math.max(50, (360 / Math.PI) * Math.atan(0.5 / aspect)));
      this.views[i].resize(
        Math.max(2, Math.round(area.width * ratio)),
        Math.max(2, Math.round(area.height * ratio)),
        step.scale,
        step.samples
      );
    });
  }

  frame(now) {
    if (this.isLost) return;
    const seconds = THREE.MathUtils.clamp((now - this.before) / 1000, 0, 0.5);
    this.quality.note(1000 * seconds);
    this.before = now;
    const { step } = this.quality,
      { isSplit, loss, asksDrawn } = this.face;
    this.match.pass(seconds, {
      loss,
      asksDrawn,
      players: isSplit ? [HERE, THERE] : [HERE],
      eyes: this.dummies.eyes,
      quality: { lightFraction: step.lightFraction, lines: step.lines }
    });
    this.#resize();
    this.controls.update();
    const hasMoved = this.#moveThings(seconds) || this.hasMoved;
    this.hasMoved = false;
    this.areas.forEach((area, i) => {
      const { camera } = this.views[i];
      camera.position.copy(this.views[HERE].camera.position);
      camera.quaternion.copy(this.views[HERE].camera.quaternion);
      this.smokes[i].stepScale = step.stepScale;
      this.views[i].draw(this.house.scene, { ...area, y: innerHeight - area.y - area.height }, hasMoved);
    });
    this.dummies.place(this.views[HERE].camera, this.areas[0]);
    this.face.showSides(this.areas);
    this.#open();
    this.#show();
  }

  #open() {
    if (!this.opening || this.match.clears < this.opening.clears) return;
    this.opening.due(this.match.tick).forEach(action => this.match.act(action));
    if (this.opening.isOver) this.#touch();
  }

  #show() {
    const { match, quality } = this,
      views = this.areas.map((_, i) => this.views[i]);
    if (!match.report) return;
    const sum = pick => views.reduce((total, view) => total + pick(view), 0);
    this.face.showTime(match.tick, match.latest, match.isPlaying);
    this.face.showDoors(match.shut);
    this.face.showMatch(match.report, match.sight);
    this.face.showCost({
      samples: sum(view => view.samples),
      uploaded: sum(view => view.smoke.uploaded),
      simulated: this.simulated,
      frame: quality.milliseconds,
      quality: quality.step.name
    });
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
