// Quality that follows the time of frames: a step down at once where they take too long, a step up on trial.
const STEPS = [
  { name: 'lowest', pixels: 0.45, scale: 0.4, samples: 0, stepScale: 2, lightFraction: 1 / 8, lines: 800 },
  { name: 'low', pixels: 0.65, scale: 0.4, samples: 0, stepScale: 1.7, lightFraction: 1 / 6, lines: 1200 },
  { name: 'medium', pixels: 1, scale: 0.5, samples: 4, stepScale: 1.4, lightFraction: 1 / 4, lines: 2400 },
  { name: 'high', pixels: 1.25, scale: 0.5, samples: 4, stepScale: 1.2, lightFraction: 1 / 3, lines: 4000 },
  { name: 'highest', pixels: 2, scale: 0.7, samples: 4, stepScale: 1, lightFraction: 1 / 2, lines: 6000 }
];
const SLOW = 26,
  FAST = 18.5; // milliseconds

export class Quality {
  /** `fixed`: the name of a step that stays, or null. */
  constructor(fixed) {
    this.fixed = STEPS.findIndex(step => step.name === fixed);
    this.at = this.fixed >= 0 ? this.fixed : 2;
    this.milliseconds = 16;
    this.since = 0;
    this.patience = 120;
  }

  get step() {
    return STEPS[this.at];
  }

  /** Takes the time since the frame before. */
  note(milliseconds) {
    this.milliseconds += 0.1 * (Math.min(milliseconds, 500) - this.milliseconds);
    this.since += 1;
    if (this.fixed >= 0) return;
    if (this.milliseconds > SLOW && this.since > 12 && this.at > 0) {
      this.at -= 1;
      this.since = 0;
      this.patience = Math.min(2 * this.patience, 4000); // it was on trial: the next comes later
    } else if (this.milliseconds < FAST && this.since > this.patience && this.at + 1 < STEPS.length) {
      this.at += 1;
      this.since = 0;
    }
  }
}
