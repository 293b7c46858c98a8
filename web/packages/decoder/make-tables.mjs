// Writes tables.js from the format's tables, or names.js: `node make-tables.mjs [names] < ../../../tests/vectors/tables.json > tables.js`.
import { readFileSync } from "node:fs";

const ROWS = ["status", "mode", "number", "step_change", "position", "velocity", "far", "status_in", "mode_after", "number_in"];
const tables = JSON.parse(readFileSync(0, "utf8"));

// A number below 46 is one letter, a larger one two; the letters are # to ~ without the backslash. Space and a letter stand for that many ones.
const letter = (index) => String.fromCharCode(index + 35 + (index > 56));
const coded = (number) => (number < 46 ? letter(number) : letter(46 + Math.floor((number - 46) / 91)) + letter((number - 46) % 91));
// Sizes add up to 4096: the last one of a table is left out.
const isIndex = (name) => name.endsWith("_in") || name === "mode_after";
const shortened = (name, table) => (Array.isArray(table[0]) ? table.map((row) => row.slice(0, -1)) : isIndex(name) ? table : table.slice(0, -1));
const numbers = ROWS.flatMap((name) => shortened(name, tables[name])).flat();
let text = "";
for (let at = 0, ones; at < numbers.length; at += ones || 1) {
  for (ones = 0; numbers[at + ones] === 1 && ones < 90; ) ones++;
  text += ones > 2 ? ` ${String.fromCharCode(ones + 35)}` : ones ? coded(1).repeat(ones) : coded(numbers[at]);
}
if (text.includes(" \\")) throw new Error("a run has a length whose letter is a backslash");

// A digit stands for a word, a star for Left in one name and Right in the next; names between commas take their sides together.
const WORDS = ["Left", "Right", "Eye", "Mouth", "Look", "Lower", "Upper", "Brow", "Cheek", "Head"];
const list = tables.live_link;
const names = [list.slice(0, 7).map((name) => name.replace("Left", "*")).join(",")];
for (let at = 14; at < list.length; at++) {
  const other = list[at].replace(/Left$/, "Right");
  names.push(other !== list[at] && list[at + 1] === other ? list[at++].replace(/Left$/, "*") : list[at]);
}
const short = WORDS.reduce((text, word, index) => text.replaceAll(word, index), names.join(" "));

const TABLES = `// The tables of the format (decoder/FORMAT.md 6), written by make-tables.mjs: sizes of symbols, and the indices that choose among the tables.
const TEXT = ${JSON.stringify(text)}.replace(/ (.)/g, (_, count) => "$".repeat(count.charCodeAt() - 35));

let at = 0;
const digit = () => {
  const code = TEXT.charCodeAt(at++) - 35;
  return code > 57 ? code - 1 : code;
};
const number = () => {
  const first = digit();
  return first < 46 ? first : 91 * first + digit() - 4140;
};
const indices = (count) => Array.from(Array(count), number);
// Sizes add up to 4096.
const sizes = (count) => {
  const row = indices(count - 1);
  return [...row, row.reduce((left, size) => left - size, 4096)];
};
const rows = (count, width) => Array.from(Array(count), () => sizes(width));

${ROWS.map((name) => {
  const table = tables[name];
  const value = Array.isArray(table[0]) ? `rows(${table.length}, ${table[0].length})` : `${isIndex(name) ? "indices" : "sizes"}(${table.length})`;
  return `export const ${name.toUpperCase()} = ${value};`;
}).join("\n")}`;

const LIST = `// Names of scalars that rigs refer to by number, written by make-tables.mjs: a digit stands for a word, and a star for Left in one name and Right in the next.
const WORDS = ${JSON.stringify(WORDS.join(" "))}.split(" ");
const NAMES = "${short}".replace(/\\d/g, (digit) => WORDS[digit]).split(" ");
const BOTH = (group) => ["Left", "Right"].flatMap((side) => group.replaceAll("*", side).split(","));
export const LIVE_LINK = [...new Set(NAMES.flatMap(BOTH))];`;

console.log(process.argv[2] ? LIST : TABLES);
