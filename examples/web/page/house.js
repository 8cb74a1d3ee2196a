// The house of the demo: its meshes, lamps, doors, and the triangles that the simulation takes.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// From candela of glTF to watts per steradian, which the demo counts in.
const WATTS = 1 / 683;
const SKY = `
  varying vec3 direction;
  float random(vec3 p) { return fract(sin(dot(p, vec3(127.1, 311.7, 74.7))) * 43758.5453); }
  void main() {
    vec3 d = normalize(direction);
    vec3 sky = mix(vec3(0.0190, 0.0230, 0.0420), vec3(0.0035, 0.0065, 0.0170), pow(clamp(d.y, 0.0, 1.0), 0.55));
    vec3 cell = floor(d * 110.0), inside = fract(d * 110.0) - 0.5;
    float star = random(cell);
    vec3 at = vec3(random(cell + 3.1), random(cell + 5.7), random(cell + 9.2)) - 0.5;
    float spot = smoothstep(0.17, 0.0, length(inside - 0.6 * at));
    sky += vec3(0.85, 0.93, 1.0) * spot * pow(star, 26.0) * 0.55 * smoothstep(0.0, 0.12, d.y);
    gl_FragColor = vec4(sky, 1.0);
  }`;

function makeSky() {
  return new THREE.Mesh(
    new THREE.SphereGeometry(300, 32, 16),
    new THREE.ShaderMaterial({
      side: THREE.BackSide,
      depthWrite: false,
      fragmentShader: SKY,
      vertexShader: `varying vec3 direction;
      void main() {
        direction = position;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        gl_Position.z = gl_Position.w * 0.99999;
      }`
    })
  );
}

/** Triangles of all meshes that stop smoke, in world space. */
function trianglesOf(root) {
  const points = [],
    indices = [],
    point = new THREE.Vector3();
  root.updateMatrixWorld(true);
  root.traverse(mesh => {
    if (!mesh.isMesh) return;
    for (let node = mesh; node; node = node.parent)
      if (node.userData.brume_ignore || node.name === 'Grenade' || node.name === 'door_leaf') return;
    const position = mesh.geometry.attributes.position,
      first = points.length / 3;
    for (let i = 0; i < position.count; ++i) {
      point.fromBufferAttribute(position, i).applyMatrix4(mesh.matrixWorld);
      points.push(point.x, point.y, point.z);
    }
    for (const index of mesh.geometry.index.array) indices.push(first + index);
  });
  return { points: new Float32Array(points), indices: new Uint32Array(indices) };
}

function adjustLights(scene, lights) {
  for (const light of lights) {
    light.intensity *= WATTS;
    if (light.name === 'lamp_sign') {
      light.distance = 7; // without shadows, which would cost more than they show
      continue;
    }
    light.castShadow = true;
    light.shadow.mapSize.setScalar(light.isDirectionalLight ? 2048 : light.isSpotLight ? 1024 : 512);
    light.shadow.bias = light.isDirectionalLight ? -0.0004 : -0.002;
    light.shadow.normalBias = light.isDirectionalLight ? 0.03 : 0.02;
    light.shadow.radius = light.isDirectionalLight ? 2 : 3;
    light.shadow.camera.near = 0.12;
    light.shadow.camera.far = 26;
    if (light.isDirectionalLight) {
      light.position.normalize().multiplyScalar(45);
      scene.add(light.target);
      light.target.position.set(0, 0, 0);
      Object.assign(light.shadow.camera, { left: -24, right: 24, top: 22, bottom: -22, near: 1, far: 90 });
    }
  }
}

/** What the smoke takes of the lights. The moon has a direction, and for the light at surfaces a place far away. */
export function lampsOf(lights) {
  return lights.map(light => {
    const position = light.getWorldPosition(new THREE.Vector3());
    const color = [light.color.r, light.color.g, light.color.b].map(c => c * light.intensity);
    if (light.isDirectionalLight)
      return { position: position.toArray(), towards: position.clone().normalize().toArray(), color };
    if (!light.isSpotLight) return { position: position.toArray(), color };
    const direction = light.target.getWorldPosition(new THREE.Vector3()).sub(position).normalize();
    return {
      position: position.toArray(),
      color,
      direction: direction.toArray(),
      inner: Math.cos(light.angle * (1 - light.penumbra)),
      outer: Math.cos(light.angle)
    };
  });
}

function panel(width, height, depth, material) {
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(width, height, depth), material);
  mesh.castShadow = mesh.receiveShadow = true;
  return mesh;
}

/** A part of the scene that the page moves or hides. */
function named(root, name) {
  const node = root.getObjectByName(name);
  if (!node) throw new Error(`scene.glb has no node named ${name}; name one so, or change house.js`);
  return node;
}

/** Leaves of the doors: set(t) with t from 0, open, to 1. */
function makeLeaves(scene, root) {
  const leaf = named(root, 'door_leaf');
  const wood = new THREE.MeshStandardMaterial({ color: new THREE.Color(0.16, 0.035, 0.03), roughness: 0.45 });
  const steel = new THREE.MeshStandardMaterial({
    color: new THREE.Color(0.16, 0.18, 0.2),
    roughness: 0.5,
    metalness: 0.4
  });
  const inner = panel(0.05, 2.34, 1.4, wood);
  const garage = new THREE.Group();
  for (let i = 0; i < 12; ++i) {
    const slat = panel(3.2, 0.215, 0.05, steel);
    slat.position.y = 0.12 + 0.2375 * i;
    garage.add(slat);
  }
  scene.add(inner, garage);
  return [
    t =>
      leaf.quaternion.setFromAxisAngle(
        new THREE.Vector3(0, 1, 0),
        -THREE.MathUtils.lerp(0.4 * Math.PI, Math.PI, t)
      ),
    t => inner.position.set(0.05, 1.27, -2.5 - 1.39 * (1 - t)),
    t => {
      garage.position.set(2.9, 0.1 + 2.72 * (1 - t), 1.88);
      garage.children.forEach((slat, i) => {
        slat.visible = slat.position.y + garage.position.y < 3.0;
      });
    }
  ];
}

export async function loadHouse(url) {
  const { scene: root } = await new GLTFLoader().loadAsync(url);
  const scene = new THREE.Scene(),
    lights = [];
  scene.add(root, makeSky());
  root.traverse(node => {
    if (node.isLight) lights.push(node);
    if (!node.isMesh) return;
    const isTree = node.name.startsWith('tree') || node.parent.name.startsWith('tree');
    node.castShadow = !isTree && node.material.emissiveIntensity <= 1;
    node.receiveShadow = true;
    for (const map of [node.material.map, node.material.normalMap]) if (map) map.anisotropy = 8;
  });
  const triangles = trianglesOf(root);
  adjustLights(scene, lights);
  scene.add(
    new THREE.HemisphereLight(new THREE.Color(0.0095, 0.0135, 0.023), new THREE.Color(0.008, 0.007, 0.007), Math.PI)
  );
  const grenade = named(root, 'Grenade');
  grenade.visible = false;
  const setDoors = makeLeaves(scene, root);
  setDoors.forEach(set => set(0));
  scene.updateMatrixWorld(true);
  return { scene, root, lights, triangles, grenade, setDoors };
}
