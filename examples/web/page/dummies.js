// Two figures that say who sees whom, and the line between their eyes.
import * as THREE from 'three';

const EYES = 1.62;
const SAYS = {
  sees: (one, other) => `${one} sees ${other}`,
  smoke: (one, other) => `${one} can’t see ${other}: smoke`,
  wall: (one, other) => `${one} can’t see ${other}: a wall`
};
const TINTS = { sees: 0x57e39a, smoke: 0xff9d5c, wall: 0xff5f5f };

function figure(color) {
  const outline = [
    [0, 0],
    [0.27, 0],
    [0.29, 0.05],
    [0.2, 0.16],
    [0.15, 0.5],
    [0.19, 1.05],
    [0.24, 1.22],
    [0.13, 1.36],
    [0.08, 1.42],
    [0.1, 1.46],
    [0, 1.46]
  ].map(([x, y]) => new THREE.Vector2(x, y));
  const material = new THREE.MeshStandardMaterial({ color, roughness: 0.55 });
  const group = new THREE.Group();
  const body = new THREE.Mesh(new THREE.LatheGeometry(outline, 40), material);
  const head = new THREE.Mesh(new THREE.SphereGeometry(0.155, 32, 20), material);
  head.position.y = EYES - 0.02;
  for (const part of [body, head]) part.castShadow = part.receiveShadow = true;
  group.add(body, head);
  return group;
}

export class Dummies {
  constructor(scene, labels) {
    this.people = [
      { name: 'Ada', at: new THREE.Vector3(-1.2, 0.02, 5.2), color: 0xd9c9a8, tint: '#ffd08a' },
      { name: 'Ben', at: new THREE.Vector3(-2.6, 0.1, -3.3), color: 0xa9c2d6, tint: '#8ccbff' }
    ];
    for (const person of this.people) {
      const mesh = figure(person.color);
      mesh.position.copy(person.at);
      scene.add(mesh);
      person.eyes = person.at.clone().setY(person.at.y + EYES);
      person.label = document.createElement('div');
      person.label.className = 'label';
      person.label.style.setProperty('--tint', person.tint);
      labels.append(person.label);
    }
    const [a, b] = this.people.map(person => person.eyes);
    this.line = new THREE.Mesh(
      new THREE.CylinderGeometry(0.009, 0.009, a.distanceTo(b) - 0.4, 8),
      new THREE.MeshBasicMaterial({ color: 0xffffff })
    );
    this.line.position.copy(a).lerp(b, 0.5);
    this.line.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), b.clone().sub(a).normalize());
    scene.add(this.line);
  }

  get eyes() {
    return this.people.map(person => person.eyes.toArray());
  }

  /** Takes what is between them: 'sees', 'smoke' or 'wall'. True: it has changed. */
  hear(answer) {
    if (answer === this.answer) return false;
    this.answer = answer;
    this.line.material.color.set(TINTS[answer]).multiplyScalar(0.55);
    this.people.forEach((person, i) => {
      person.says = SAYS[answer](person.name, this.people[1 - i].name);
    });
    return true;
  }

  /** Moves the labels above the heads, in an area of the window, one above the other where they would overlap. */
  place(camera, area) {
    const point = new THREE.Vector3();
    let last = null;
    for (const { eyes, label, says } of this.people) {
      point
        .copy(eyes)
        .setY(eyes.y + 0.32)
        .project(camera);
      label.hidden = point.z >= 1 || Math.abs(point.x) >= 1 || Math.abs(point.y) >= 1;
      if (label.textContent !== says) label.textContent = says;
      if (label.hidden) continue;
      const half = 0.5 * label.offsetWidth + 6,
        height = label.offsetHeight + 4;
      const across = area.x + area.width * (0.5 + 0.5 * point.x);
      const x = Math.min(Math.max(across, area.x + half), area.x + area.width - half);
      let y = area.y + area.height * (0.5 - 0.5 * point.y);
      if (last && Math.abs(x - last.x) < half + last.half && Math.abs(y - last.y) < height) y = last.y + height;
      last = { x, y, half };
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -100%)`;
    }
  }
}
