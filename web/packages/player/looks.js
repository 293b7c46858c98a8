// What <pantin-player> loads for its attribute `character-look`: reads a character of the solid figure (docs/LOOKS.md), as text or compiled.

const MATERIALS = "shirt trousers skin hair face nose eye left right right-end edge stage floor shadow".split(" ");
// Materials of the body; those after them have these colors in the default character, which a page replaces by its own.
const OF_BODY = 7;
const UNSTATED = ["ffa03c", "50beff", "50beff", "06080e", "242c40", "38445c", "0e121c"];
const ANCHORS = ["head", "chest", "hips", "thighs"];
const PATTERNS = ["dark", "bright", "checkered"];
const STATEMENTS = ["radius", "outline", "colour", "attach"];
// Greatest radius of a part, in thousandths of the height, and the multiple of thousandths that places of attachments are.
const [MOST_RADIUS, STEP] = [200, 2];
const [MOST_ATTACHMENTS, MOST_BYTES, FIXED] = [12, 200, 90];
const CIRCLES = "an attachment has one to 4 circles, each of four numbers: left, up, ahead, radius";

const fail = (problem) => {
  throw new Error(problem);
};
const numberOf = (word, from, to, problem = `expected a whole number from ${from} to ${to}`) => (/^[+-]?\d+$/.test(word) && word >= from && word <= to ? +word : fail(problem));
const indexOf = (names, word) => (names.includes(word) ? names.indexOf(word) : fail(`expected one of ${names.join(", ")}`));
const isColor = (word) => /^[\da-f]{6}$/i.test(word);
const colorOf = (word) => (isColor(word) ? [0, 2, 4].map((at) => parseInt(word.slice(at, at + 2), 16)) : fail("expected a colour of six hexadecimal digits, RRGGBB"));

// How far attachments reach from head, chest, and hips or thighs.
const reachesOf = (attachments) => [0, 1, 2].map((group) => Math.max(0, ...attachments.filter(({ anchor }) => Math.min(anchor, 2) === group)
  .flatMap(({ circles }) => circles.map(([left, up, ahead, radius]) => Math.ceil((Math.floor(Math.sqrt(left * left + up * up + ahead * ahead)) + 1 + radius) / 4) * 4))));
const standardOf = (material) => colorOf(UNSTATED[MATERIALS.indexOf(material) - OF_BODY]);

function ofText(text, { names, outline, radii: [large, small], colors }) {
  const look = { outline, radii: [[...large], [...small]], colors: { ...colors }, attachments: [] };
  let bytes = FIXED;
  const take = (words) => {
    const next = () => words.shift();
    const shade = () => {
      numberOf(next(), 0, 15, "expected a grey from 0 to 15");
      return true;
    };
    const statement = indexOf(STATEMENTS, next());
    if (statement === 0) {
      const part = indexOf(names, next());
      const radius = numberOf(next(), 1, MOST_RADIUS);
      look.radii[0][part] = radius;
      // Small figures get as much more as the default character does.
      look.radii[1][part] = words.length ? numberOf(next(), 1, MOST_RADIUS) : Math.max(1, Math.min(MOST_RADIUS, radius + small[part] - large[part]));
    } else if (statement === 1) look.outline = numberOf(next(), 20, 255);
    else if (statement === 2) {
      const material = MATERIALS[indexOf(MATERIALS, next())];
      look.colors[material] = colorOf(next());
      if (words.length && shade() && words.length) indexOf(PATTERNS, next());
    } else {
      const anchor = indexOf(ANCHORS, next());
      const word = next();
      const color = isColor(word) ? colorOf(word) : (look.colors[MATERIALS[indexOf(MATERIALS, word)]] ?? standardOf(word));
      if (isColor(word) && shade()) indexOf(PATTERNS, next());
      const circles = [];
      while (words.length) {
        const place = () => Math.trunc(numberOf(next() ?? fail(CIRCLES), -127 * STEP, 127 * STEP) / STEP) * STEP;
        circles.push([place(), place(), place(), Math.trunc(numberOf(next() ?? fail(CIRCLES), STEP, 125 * STEP) / STEP) * STEP]);
      }
      if (!circles.length || circles.length > 4) fail(CIRCLES);
      look.attachments.push({ anchor, color, circles });
      bytes += 5 + 4 * circles.length;
      if (look.attachments.length > MOST_ATTACHMENTS || bytes > MOST_BYTES) fail(`the character has more than ${MOST_ATTACHMENTS} attachments or ${MOST_BYTES} bytes with this line`);
    }
    if (words.length) fail("there are more words than the statement has");
  };
  text.split("\n").forEach((line, index) => {
    const words = line.split("#")[0].split(/\s+/).filter(Boolean);
    try {
      if (words.length) take(words);
    } catch ({ message }) {
      fail(`line ${index + 1}: ${message}`);
    }
  });
  return look;
}

// Compiled: outline, radii, tints of four bytes each, reaches, and attachments.
function ofBytes(bytes, { names }) {
  const parts = names.length;
  const radii = [2, 2 + parts].map((at) => [...bytes.subarray(at, at + parts)]);
  const look = { outline: bytes[1], radii, colors: {}, attachments: [] };
  const good = (holds) => holds || fail("these bytes are no character");
  good(bytes.length >= FIXED && bytes.length <= MOST_BYTES && !bytes.subarray(1, 2 + 2 * parts).includes(0));
  const tintAt = (at) => {
    good((bytes[at + 3] & 15) < 3);
    return [...bytes.subarray(at, at + 3)];
  };
  MATERIALS.forEach((name, index) => (look.colors[name] = tintAt(2 + 2 * parts + 4 * index)));
  let at = FIXED;
  for (let left = bytes[FIXED - 1]; left--; ) {
    const [anchor, count] = [bytes[at] >> 4, (bytes[at] & 15) + 1];
    good(anchor < 4 && count < 5 && at + 5 + 4 * count <= bytes.length && look.attachments.length < MOST_ATTACHMENTS);
    const circles = Array.from({ length: count }, (_, circle) => [0, 1, 2, 3].map((index) => STEP * (index < 3 ? (bytes[at + 5 + 4 * circle + index] << 24) >> 24 : bytes[at + 5 + 4 * circle + index])));
    look.attachments.push({ anchor, color: tintAt(at + 1), circles });
    at += 5 + 4 * count;
  }
  good(at === bytes.length);
  return look;
}

/**
 * A character of the bytes of a file, text or compiled. `standard` has what a file does not state: names of the radii, the radii of large and small figures and the
 * outline as in the file, and colors by material. Throws an error that says what is wrong with it, of a text with its line.
 */
export function lookOf(bytes, standard) {
  const look = bytes[0] === 1 ? ofBytes(bytes, standard) : ofText(new TextDecoder().decode(bytes), standard);
  for (const material of MATERIALS.slice(OF_BODY)) if (`${look.colors[material]}` === `${standardOf(material)}`) delete look.colors[material];
  return { ...look, reaches: reachesOf(look.attachments) };
}
