// The match in a thread of its own, so that pictures need not wait for it. A message is {create} once, then requests of
// {tick, loss, actions, players, seconds, quality, eyes, asksDrawn}; each has one answer.
import { DOORS, LEVEL } from './level.js';
import { HERE, Simulation } from './simulation.js';

let simulation,
  clears = 0,
  renewals = 0,
  tick = 0,
  latest = 0,
  doorEvents = [],
  shut = DOORS.map(() => false);

const along = (from, direction, t) => from.map((p, i) => p + t * direction[i]);

/** How far a ray gets before it is well inside of smoke, or to its end. */
function intoSmoke({ eye, direction, distance }) {
  for (let t = 0.5; t < distance; t += 0.5)
    if (simulation.depth(HERE, eye, along(eye, direction, t)) > 1) return t + 0.7;
  return distance - 0.4;
}

function shutAt(now) {
  const doors = DOORS.map(() => false);
  for (const event of doorEvents) if (event.tick <= now) doors[event.door] = event.solid;
  return doors;
}

// What a tap does, at the present tick. A ray is {eye, direction, distance}.
const ACTIONS = {
  throw: ({ from, at, amount = 260 }) => simulation.throwSmoke(from, at, amount, 2.4),
  shoot: ({ from, at }) => simulation.shoot(from, at, 0.2, 1.6),
  blast: ({ ray }) => simulation.blast(along(ray.eye, ray.direction, intoSmoke(ray)), 3.2),
  // Letters side by side, as large as fits into a width that grows with the distance; all from the eye, for which they
  // are open.
  word: ({ ray, right, letters, share }) => {
    const depth = intoSmoke(ray),
      widest = Math.max(2.4, 2 * Math.max(...letters.map(letter => Math.abs(letter.right))) + 1);
    const edge = Math.min(1.6, (share * depth) / widest);
    for (const { mask, right: aside } of letters) {
      const place = along(along(ray.eye, ray.direction, depth), right, edge * aside);
      simulation.shoot(
        ray.eye,
        ray.eye.map((p, i) => p + 4 * (place[i] - p)),
        edge / 2,
        6,
        mask
      );
    }
  },
  door: ({ door }) => {
    const solid = !shutAt(tick + 1)[door];
    simulation.edit(DOORS[door].low, DOORS[door].high, solid);
    doorEvents = [...doorEvents, { tick: tick + 1, door, solid }].sort((a, b) => a.tick - b.tick);
  },
  renew: () => {
    simulation.renew();
    renewals += 1;
  },
  clear: () => {
    simulation.clear();
    clears += 1;
    doorEvents = [];
    latest = 0;
  }
};

function create({ url, masks, texels, triangles, lamps }) {
  for (const mask of masks) simulation.addMask(texels, texels, mask);
  simulation.create({ ...triangles, ...LEVEL });
  for (const lamp of lamps) {
    simulation.addLight(lamp);
    simulation.addTextureLight(lamp.towards ?? lamp.position, Boolean(lamp.towards));
  }
}

function goTo(wanted, loss) {
  if (wanted === tick) return;
  simulation.goTo(wanted, loss);
  tick = wanted;
  latest = Math.max(latest, tick);
  const doors = shutAt(tick);
  if (doors.join() !== shut.join()) simulation.restartLight();
  shut = doors;
}

/** What a player sees, copied out of the module's memory. */
function seenBy(player, seconds, { lightFraction, lines }) {
  const { textures, regions, constants } = simulation.update(player, seconds, lightFraction);
  const copy = new Uint8Array(regions.reduce((sum, region) => sum + ((region.bytes + 15) & ~15), 0));
  let at = 0;
  for (const region of regions) {
    copy.set(simulation.module.HEAPU8.subarray(region.at, region.at + region.bytes), at);
    region.at = at;
    at += (region.bytes + 15) & ~15;
  }
  const left = simulation.light(player, lines).slice();
  return { player, textures, regions, texels: copy.buffer, constants: constants.slice(), left };
}

function answer({ tick: wanted, loss, actions, players, seconds, quality, eyes, asksDrawn }) {
  const begun = performance.now();
  for (const action of actions) ACTIONS[action.kind](action);
  goTo(wanted, loss);
  const seen = players.map(player => seenBy(player, seconds, quality));
  const sight = simulation.sees(HERE, ...eyes, asksDrawn);
  const report = simulation.report(),
    milliseconds = performance.now() - begun;
  return { clears, renewals, tick, latest, shut, seen, sight, report, milliseconds };
}

onmessage = async ({ data }) => {
  try {
    if (data.create) {
      simulation = await Simulation.load(data.create.url);
      create(data.create);
      postMessage({ isReady: true });
      return;
    }
    const reply = answer(data);
    postMessage(
      reply,
      reply.seen.flatMap(({ texels, left }) => [texels, left.buffer])
    );
  } catch (error) {
    postMessage({ error: error.message });
  }
};
