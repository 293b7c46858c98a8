// A WebM file of pictures that a browser's encoder compressed as VP8: with its duration and an index, so that players can seek.

// Ids of the elements used, as in RFC 9559.
const [EBML, EBML_VERSION, EBML_READ_VERSION, EBML_MAX_ID, EBML_MAX_SIZE, DOC_TYPE, DOC_VERSION, DOC_READ_VERSION] = [0x1a45dfa3, 0x4286, 0x42f7, 0x42f2, 0x42f3, 0x4282, 0x4287, 0x4285];
const [SEGMENT, INFO, SCALE, DURATION, MUXER, WRITER] = [0x18538067, 0x1549a966, 0x2ad7b1, 0x4489, 0x4d80, 0x5741];
const [TRACKS, ENTRY, NUMBER, UID, KIND, LACING, CODEC, VIDEO, WIDTH, HEIGHT] = [0x1654ae6b, 0xae, 0xd7, 0x73c5, 0x83, 0x9c, 0x86, 0xe0, 0xb0, 0xba];
const [CUES, POINT, CUE_TIME, PLACE, CUE_TRACK, CUE_CLUSTER] = [0x1c53bb6b, 0xbb, 0xb3, 0xb7, 0xf7, 0xf1];
const [CLUSTER, TIME, BLOCK] = [0x1f43b675, 0xe7, 0xa3];
const NAME = "pantin";

// The value's bytes, the most significant one first.
function bytes(value, count) {
  const all = new Uint8Array(count);
  for (; count; value = Math.floor(value / 256)) all[--count] = value % 256;
  return all;
}

const text = (value) => new TextEncoder().encode(value);
const float = (value) => {
  const view = new DataView(new ArrayBuffer(8));
  view.setFloat64(0, value);
  return new Uint8Array(view.buffer);
};

// An element: its id, its size in eight bytes, its contents. Numbers take eight bytes, too, so that sizes are known before the values are.
function element(id, ...contents) {
  const parts = contents.flatMap((one) => (typeof one === "number" ? bytes(one, 8) : one));
  const size = bytes(length(parts), 8);
  size[0] = 1;
  return [bytes(id, Math.ceil(Math.log2(id + 1) / 8)), size, ...parts];
}
const length = (parts) => parts.reduce((all, { length }) => all + length, 0);

// Pictures are { data: Uint8Array, isKey, time }, times and the duration in milliseconds. A key picture begins a cluster, which may last 32 s.
export function webm(pictures, width, height, duration) {
  const head = element(EBML, ...[
    [EBML_VERSION, 1], [EBML_READ_VERSION, 1], [EBML_MAX_ID, 4], [EBML_MAX_SIZE, 8], [DOC_TYPE, text("webm")], [DOC_VERSION, 2], [DOC_READ_VERSION, 2],
  ].map(([id, value]) => element(id, value)));
  const about = [
    // Times count milliseconds: a million nanoseconds.
    ...element(INFO, element(SCALE, 1e6), element(DURATION, float(duration)), element(MUXER, text(NAME)), element(WRITER, text(NAME))),
    ...element(TRACKS, element(ENTRY, element(NUMBER, 1), element(UID, 1), element(KIND, 1), element(LACING, 0), element(CODEC, text("V_VP8")), element(VIDEO, element(WIDTH, width), element(HEIGHT, height)))),
  ];
  const clusters = [];
  for (const { data, isKey, time } of pictures) {
    if (isKey) clusters.push({ time, blocks: [] });
    const { time: begun, blocks } = clusters.at(-1);
    blocks.push(element(BLOCK, Uint8Array.of(0x81), bytes(time - begun, 2), Uint8Array.of(isKey ? 0x80 : 0), data));
  }
  const written = clusters.map(({ time, blocks }) => element(CLUSTER, element(TIME, time), ...blocks));
  const cues = (starts) => element(CUES, ...clusters.map(({ time }, index) => element(POINT, element(CUE_TIME, time), element(PLACE, element(CUE_TRACK, 1), element(CUE_CLUSTER, starts[index])))));
  // Where the clusters begin in the segment, after an index of a size that does not depend on it.
  let at = length(about) + length(cues(clusters.map(() => 0)));
  const starts = written.map((parts) => {
    const start = at;
    at += length(parts);
    return start;
  });
  return [...head, ...element(SEGMENT, about, cues(starts), ...written)];
}
