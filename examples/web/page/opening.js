// What happens before anyone has touched the page: a grenade through the front door, a burst of fire, one more
// grenade, and a word.
import { TICKS_PER_SECOND } from './simulation.js';

const GUN = [-5.0, 1.4, 10.4];
const BURST = { from: [-4.1, 0.9, 0.4], to: [-2.2, 1.3, 0.4], shots: 5, seconds: 0.11 };

/** Acts in the order of their times: {seconds, action}. */
function acts(word) {
  const shots = Array.from({ length: BURST.shots }, (_, i) => ({
    seconds: 2.0 + i * BURST.seconds,
    action: {
      kind: 'shoot',
      from: GUN,
      at: BURST.from.map((p, axis) => p + (i / (BURST.shots - 1)) * (BURST.to[axis] - p))
    }
  }));
  return [
    // Through the front door.
    { seconds: 0, action: { kind: 'throw', from: [-3.4, 1.8, 10], at: [-2.6, 0.4, -3], amount: 375 } },
    ...shots,
    { seconds: 2.7, action: { kind: 'throw', from: [-4.6, 1.2, 9.6], at: [-3, 0.2, 2.3], amount: 85 } },
    { seconds: 5.2, action: word }
  ];
}

export class Opening {
  /** `clears`: of the match that it opens. `word`: the action that shoots it. */
  constructor(clears, word) {
    this.clears = clears;
    this.left = acts(word);
  }

  /** Hands out what is due at a tick. */
  due(tick) {
    const now = tick / TICKS_PER_SECOND,
      count = this.left.filter(({ seconds }) => seconds <= now).length;
    return this.left.splice(0, count).map(({ action }) => action);
  }

  get isOver() {
    return this.left.length === 0;
  }
}
