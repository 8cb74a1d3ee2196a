// What surrounds the picture: tools, doors, players, time, and the cost of a frame.
import { TICKS_PER_SECOND } from './simulation.js';

const ICONS = {
  throw: '<path d="M7 18a4 4 0 0 1-.6-7.9A5.5 5.5 0 0 1 17 9.2 4.4 4.4 0 0 1 17 18z"/>',
  shoot: '<circle cx="12" cy="12" r="7"/><path d="M12 2v5M12 17v5M2 12h5M17 12h5"/>',
  word: '<path d="M5 19 11 5h2l6 14M7.5 14h9"/>',
  blast:
    '<path d="m12 2 2.2 6 5.6-3-3 5.6 6 2.2-6 2.2 3 5.6-5.6-3L12 23l-2.2-5.4-5.6 3 3-5.6-6-2.2 6-2.2-3-5.6 5.6 3z"/>'
};
const TOOLS = [
  ['throw', 'Throw'],
  ['shoot', 'Shoot'],
  ['word', 'Word'],
  ['blast', 'Blast']
];
// What a tap does, for those who have not tried it yet.
const HINTS = {
  throw: 'to throw smoke, drag to look around',
  shoot: 'to shoot a hole through the smoke',
  word: 'to shoot the word through the smoke',
  blast: 'to blow the smoke away'
};
const TAP = matchMedia('(pointer: coarse)').matches ? 'Tap' : 'Click';
const PLAY = '<svg viewBox="0 0 24 24"><path d="M8 5.5v13l10.5-6.5z" fill="currentColor"/></svg>';
const PAUSE = '<svg viewBox="0 0 24 24"><path d="M8.5 6v12M15.5 6v12" stroke-width="2.6"/></svg>';

const element = id => document.getElementById(id);
const thousands = n =>
  n >= 1e6 ? `${(n / 1e6).toFixed(1)} M` : n >= 1e3 ? `${Math.round(n / 1e3)} k` : `${Math.round(n)}`;

export class Interface {
  /** `doors`: their names; `does`: what the page does, {seek, restart, setPlaying, toggleDoor}. */
  constructor(doors, does) {
    this.tool = 'throw';
    this.isNew = new Set(); // tools whose hint is shown
    this.tools = TOOLS.map(([tool, name]) => {
      const button = document.createElement('button');
      button.id = `tool-${tool}`;
      button.innerHTML = `<svg viewBox="0 0 24 24">${ICONS[tool]}</svg>${name}`;
      button.addEventListener('click', () => this.choose(tool));
      element('tools').append(button);
      return { tool, button };
    });
    this.choose('throw');
    this.doors = doors.map((name, i) => {
      const button = document.createElement('button');
      button.id = `door-${name.toLowerCase()}`;
      button.addEventListener('click', () => does.toggleDoor(i));
      element('doors').append(button);
      return { name, button };
    });
    element('open').addEventListener('click', () => this.#showPanel(!element('panel').classList.contains('shown')));
    element('word-form').addEventListener('submit', event => {
      event.preventDefault();
      element('word').blur();
    });
    element('play').addEventListener('click', () => does.setPlaying(!this.isPlaying));
    element('restart').addEventListener('click', does.restart);
    element('slider').addEventListener('input', () => does.seek(Number(element('slider').value)));
    element('loss').addEventListener('input', () => {
      element('loss-shown').textContent = `${element('loss').value} %`;
    });
    if (matchMedia('(min-width: 1500px)').matches) this.#showPanel(true);
  }

  #showPanel(isShown) {
    element('panel').classList.toggle('shown', isShown);
    element('open').setAttribute('aria-expanded', isShown);
  }

  choose(tool) {
    this.tool = tool;
    for (const { tool: other, button } of this.tools) button.setAttribute('aria-pressed', other === tool);
    element('word-form').hidden = tool !== 'word';
    this.#hint();
  }

  #hint() {
    element('hint').hidden = !this.isNew.has(this.tool);
    element('hint').textContent = `${TAP} ${HINTS[this.tool]}`;
  }

  /** Says what a tap does, for each tool until it is used. */
  invite() {
    this.isNew = new Set(Object.keys(HINTS));
    this.#hint();
  }

  /** A tap at a point of the window: a ring, and the tool is known. */
  showTap(x, y) {
    const ring = document.createElement('div');
    ring.className = 'tap';
    Object.assign(ring.style, { left: `${x}px`, top: `${y}px` });
    ring.addEventListener('animationend', () => ring.remove());
    document.body.append(ring);
    this.isNew.delete(this.tool);
    this.#hint();
  }

  /** Names the two players' parts of the window, where both are shown. */
  showSides(areas) {
    ['side-server', 'side-player'].forEach((id, i) => {
      element(id).hidden = areas.length < 2;
      if (areas.length < 2) return;
      const { x, y, width } = areas[i],
        isBelow = areas[1].y > 0;
      const top = isBelow ? y + (i === 0 ? 62 : 12) : 96;
      element(id).style.transform = `translate(${x + width / 2}px, ${top}px) translateX(-50%)`;
    });
    element('side-player').textContent = `A player, ${element('loss').value} % of packets lost`;
  }

  get word() {
    return element('word').value;
  }
  get loss() {
    return Number(element('loss').value) / 100;
  }
  get isSplit() {
    return element('split').checked;
  }
  get asksDrawn() {
    return element('drawn').checked;
  }

  showTime(tick, latest, isPlaying) {
    const slider = element('slider');
    slider.max = Math.max(latest, TICKS_PER_SECOND);
    slider.value = tick;
    element('clock').textContent = `${(tick / TICKS_PER_SECOND).toFixed(1)} s`;
    if (isPlaying === this.isPlaying) return;
    this.isPlaying = isPlaying;
    element('play').innerHTML = isPlaying ? PAUSE : PLAY;
    element('play').title = isPlaying ? 'Pause' : 'Play';
  }

  showDoors(shut) {
    this.doors.forEach(({ name, button }, i) => {
      const text = shut[i] ? `${name} shut` : name;
      if (button.textContent !== text) button.textContent = text;
      button.setAttribute('aria-pressed', shut[i]);
    });
  }

  showMatch(report, answer) {
    const [first, second] = report.hashes;
    element('hash-here').textContent = first;
    element('hash-there').textContent = report.ticks[1] > 0 || second !== '0000000000000000' ? second : 'waiting';
    const isEqual = second === report.serverThen,
      behind = report.ticks[0] - report.ticks[1];
    element('equal').textContent = isEqual ? `yes, at the tick ${behind} before` : 'no';
    element('equal').className = isEqual ? 'good' : 'bad';
    element('packets').textContent =
      `${thousands(report.packets)}, ${thousands(report.lost)} lost, ` +
      `${Math.round(report.bytes / Math.max(1, report.packets))} B each`;
    element('sight').textContent = {
      sees: 'Ada and Ben see each other',
      smoke: 'Smoke is between them',
      wall: 'A wall is between them'
    }[answer];
    element('sight').className = `big ${answer === 'sees' ? 'good' : 'bad'}`;
  }

  showCost({ samples, uploaded, simulated, frame, quality }) {
    element('samples').textContent = `${thousands(samples)} at most`;
    element('uploaded').textContent = `${thousands(uploaded)}B`;
    element('simulated').textContent = `${simulated.toFixed(1)} ms, aside`;
    element('frame').textContent = `${frame.toFixed(0)} ms`;
    element('quality').textContent = quality;
  }
}

/** The cover's only sentence while there is nothing to see, or instead of it. */
export function showMessage(text, hasFailed = false) {
  element('message').textContent = text;
  element('cover').classList.toggle('failed', hasFailed);
  element('cover').classList.remove('done');
}

export function uncover() {
  element('cover').classList.remove('failed');
  element('cover').classList.add('done');
}
