// Bounds that a clip is converted with: the options, and what they promise (docs/IMPORT.md, "What a bound covers").

const DEFAULT_CM = 0.5, SHELL_CM = 3, SHELL_PERCENT = 3, TALL_CM = 100;
const PROMISES = { "--max-error": "cm", "--max-rotation-error": "rotation", "--max-joint-error": "joint", "--mean-error": "mean", "--shell": "shell" };

/** The bounds that every captured motion is converted with. */
export const BOUNDS = [
  "", "--max-error 0.3cm", "--max-error 1cm", "--max-error 3cm",
  "--max-error 1cm --shell 10cm", "--max-error 1cm --shell 1%", "--max-error 0.4%", "--mean-error 0.2cm",
  "--max-rotation-error 3", "--max-joint-error 2", "--max-error 3cm --max-rotation-error 1.5 --max-joint-error 1",
  "--places-only", "--places-only --max-error 2cm --max-rotation-error 5", "--places-only --max-error 2cm --max-joint-error 4",
  "--rotations euler --max-rotation-error 2", "--rotations exponential --max-rotation-error 2", "--rotations quaternion --max-rotation-error 2",
  "--rotations quaternion --max-error 1cm --max-joint-error 1.5", "--rotations exponential --max-error 1cm --max-joint-error 1.5",
];

/** What options promise for a figure of a height in cm: the greatest error of each kind, and the radius of the shells in cm. */
export function promiseOf(options, heightCm) {
  const words = options.split(" "), given = {};
  for (const [option, what] of Object.entries(PROMISES)) if (words.includes(option)) given[what] = words[words.indexOf(option) + 1];
  const length = (text) => (text.endsWith("%") ? (parseFloat(text) / 100) * heightCm : parseFloat(text));
  const placesOnly = words.includes("--places-only"), isSmall = heightCm > 0 && heightCm < TALL_CM;
  const most = given.cm ? length(given.cm) : given.mean ? 6 * length(given.mean) : DEFAULT_CM;
  const angle = (text) => (text === undefined ? Infinity : Number(text));
  return {
    radiusCm: given.shell ? length(given.shell) : isSmall ? (SHELL_PERCENT / 100) * heightCm : SHELL_CM,
    most: { place: most, shell: placesOnly ? Infinity : most, rotation: angle(given.rotation), joint: angle(given.joint) },
  };
}
