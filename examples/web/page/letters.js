// Letters as masks of shots: drawn on a canvas with a font of this machine. All players need the same images.

const GLYPHS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789!?&+-.♥';
const TEXELS = 64;
const FONT = '700 50px Inter, "Helvetica Neue", Arial, "DejaVu Sans", sans-serif';

/** {masks, texels, layout}: the images with as many texels per edge, and where letters of a word go. */
export function makeLetters() {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = TEXELS;
  const context = canvas.getContext('2d', { willReadFrequently: true });
  Object.assign(context, { font: FONT, textAlign: 'center', textBaseline: 'alphabetic', fillStyle: '#fff' });
  const masks = [],
    widths = new Map([[' ', 0.36]]);
  [...GLYPHS].forEach(glyph => {
    context.clearRect(0, 0, TEXELS, TEXELS);
    context.fillText(glyph, TEXELS / 2, 50);
    widths.set(glyph, Math.min(context.measureText(glyph).width, TEXELS) / TEXELS);
    const pixels = context.getImageData(0, 0, TEXELS, TEXELS).data;
    const texels = Uint8Array.from({ length: TEXELS * TEXELS }, (_, i) => pixels[4 * i + 3]);
    masks.push(texels);
  });

  /** [{mask, right}]: each letter's image and its place, in edges of an image, from the middle of the word. */
  function layout(word) {
    const letters = [...word.toUpperCase()].filter(glyph => widths.has(glyph));
    const gap = 0.05,
      whole = letters.reduce((sum, glyph) => sum + widths.get(glyph) + gap, -gap);
    let right = -whole / 2;
    return letters
      .map(glyph => {
        const width = widths.get(glyph),
          at = right + width / 2;
        right += width + gap;
        return { mask: [...GLYPHS].indexOf(glyph), right: at };
      })
      .filter(letter => letter.mask >= 0);
  }
  return { masks, texels: TEXELS, layout };
}
