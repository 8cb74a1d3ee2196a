extends Reference
# Letters as masks of a match, from rows of five dots.

const LETTERS = {
	"B": ["XXXX ", "X   X", "X   X", "XXXX ", "X   X", "X   X", "XXXX "],
	"R": ["XXXX ", "X   X", "X   X", "XXXX ", "X X  ", "X  X ", "X   X"],
	"U": ["X   X", "X   X", "X   X", "X   X", "X   X", "X   X", " XXX "],
	"M": ["X   X", "XX XX", "X X X", "X X X", "X   X", "X   X", "X   X"],
	"E": ["XXXXX", "X    ", "X    ", "XXXX ", "X    ", "X    ", "XXXXX"]}

# The mask of each letter of the match, whose level is set afterwards.
static func add_to(match_):
	var masks = {}
	for letter in LETTERS:
		var image = Image.new()
		image.create(9, 9, false, Image.FORMAT_L8)
		image.lock()
		for y in range(7):
			for x in range(5):
				if LETTERS[letter][y][x] == "X":
					image.set_pixel(x + 2, y + 1, Color.white)
		image.unlock()
		image.resize(72, 72, Image.INTERPOLATE_CUBIC)
		var texels = image.get_data()
		for i in range(len(texels)):
			# Round corners, and strokes that are as wide as the dots.
			texels[i] = int(255 * smoothstep(0.32, 0.55, texels[i] / 255.0))
		masks[letter] = match_.add_mask(72, 72, texels)
	return masks
