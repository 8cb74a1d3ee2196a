// The match as the page has it: requests to the worker, one at a time, and what its last answer said.
import { TICKS_PER_SECOND } from './simulation.js';

const MOST_TICKS = 24; // of one answer: where it takes longer, time passes slowly

export class Match {
  /** `create`: what the worker begins with. `took(reply)` hears every answer, `failed(message)` an error. */
  static async begin(create, took, failed) {
    const match = new Match(took, failed);
    await new Promise(ready => {
      match.ready = ready;
      match.worker.postMessage({ create });
    });
    return match;
  }

  constructor(took, failed) {
    Object.assign(this, {
      took,
      failed,
      actions: [],
      isBusy: false,
      isPlaying: true,
      exact: 0,
      tick: 0,
      latest: 0,
      renewals: 0,
      shut: []
    });
    this.worker = new Worker(new URL('worker.js', import.meta.url), { type: 'module' });
    this.worker.onmessage = ({ data }) => this.#hear(data);
    this.worker.onerror = event => failed(event.message ?? 'The simulation did not load.');
  }

  #hear(data) {
    if (data.error) return this.failed(data.error);
    if (data.isReady) return this.ready();
    this.isBusy = false;
    const { clears, tick, latest, shut, report, sight } = data;
    Object.assign(this, { clears, tick, latest, shut, report, sight });
    this.took(data);
  }

  /** At the present tick; time goes on. */
  act(action) {
    this.actions.push(action);
    this.isPlaying = true;
  }

  /** From the first tick, without any event. Returns what `clears` then is. */
  restart() {
    this.act({ kind: 'clear' });
    this.exact = 0;
    return this.clears + 1;
  }

  /** All textures are handed out again, whole. */
  renew() {
    this.renewals += 1;
    this.actions.push({ kind: 'renew' });
  }

  seek(tick) {
    this.isPlaying = false;
    this.exact = tick;
  }

  /** Lets time pass, and asks where the worker is idle. `request`: what does not depend on time. */
  pass(seconds, request) {
    if (this.isPlaying) this.exact = Math.min(this.exact + seconds * TICKS_PER_SECOND, this.tick + MOST_TICKS);
    if (this.isBusy) return;
    this.isBusy = true;
    const tick = Math.floor(this.exact);
    this.worker.postMessage({ ...request, tick, seconds: this.exact / TICKS_PER_SECOND, actions: this.actions });
    this.actions = [];
  }
}
