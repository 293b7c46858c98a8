// Names of scalars that rigs refer to by number, written by make-tables.mjs: a digit stands for a word, and a star for Left in one name and Right in the next.
const WORDS = "Left Right Eye Mouth Look Lower Upper Brow Cheek Head".split(" ");
const NAMES = "2Blink*,24Down*,24In*,24Out*,24Up*,2Squint*,2Wide* JawForward Jaw1 Jaw0 JawOpen 3Close 3Funnel 3Pucker 31 30 3Smile* 3Frown* 3Dimple* 3Stretch* 3Roll5 3Roll6 3Shrug5 3Shrug6 3Press* 35Down* 36Up* 7Down* 7InnerUp 7OuterUp* 8Puff 8Squint* NoseSneer* TongueOut 9Yaw 9Pitch 9Roll 02Yaw 02Pitch 02Roll 12Yaw 12Pitch 12Roll".replace(/\d/g, (digit) => WORDS[digit]).split(" ");
const BOTH = (group) => ["Left", "Right"].flatMap((side) => group.replaceAll("*", side).split(","));
export const LIVE_LINK = [...new Set(NAMES.flatMap(BOTH))];
