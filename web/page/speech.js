// A face that speaks, by the microphone or a sentence made of vowels and noise. The mouth's weights are those of talk.js.
import { RATES, samplesOf, Talk } from "./talk.js";

// The weights of the face: MPEG-4's visemes 1 to 14, then what lets it look awake.
const NAMES = [..."pp ff th dd kk ch ss nn rr aa e i o u".split(" ").map((name) => `viseme_${name}`), "lid_left", "lid_right", "corner_up_left", "corner_up_right"];
const VISEMES = 14;
const LID = 14;
const SMILE = 16;
// Of a scalar with exponent 1, 2^30 is 1.
const ONE = 2 ** 30;
// A blink, and the time between two, in milliseconds.
const BLINK = 160;
const BLINKS = [2600, 3900, 3100];

// How long sound may take to begin, in milliseconds.
const PATIENCE = 3000;

// The rig of these weights, as decoder/FORMAT.md has it: no joint, and each scalar with its name.
function rigOf(names) {
  const bytes = [0xc0, 0x84, 0x3d, 0, 1, 0, names.length, ...names.flatMap((name) => [1, name.length, ...new TextEncoder().encode(name)])];
  let crc = 0xffff;
  for (const byte of bytes) {
    crc ^= byte << 8;
    for (let bit = 8; bit--; ) crc = crc & 0x8000 ? ((crc << 1) ^ 0x1021) & 0xffff : crc << 1;
  }
  return Uint8Array.from([...bytes, crc & 255, crc >> 8]);
}

// "Hello, my name is Pantin": seconds, pitch in Hz, loudness, and for a vowel three formants; without them noise of s and h, and nothing while lips or tongue close the mouth.
const H = [0.07, 0, 0.05];
const CLOSED = [0.09, 0, 0];
const SENTENCE = [
  CLOSED, H, [0.11, 128, 0.8, [560, 1800, 2500]], [0.07, 124, 0.4, [380, 1000, 2600]], [0.2, 118, 0.9, [480, 880, 2400]], [0.3, 0, 0],
  [0.09, 120, 0.15, [250, 1000, 2200]], [0.13, 124, 1, [760, 1250, 2500]], [0.09, 120, 0.6, [330, 2200, 2900]],
  [0.08, 118, 0.15, [250, 1400, 2400]], [0.14, 126, 0.9, [530, 1850, 2550]], [0.08, 120, 0.6, [340, 2150, 2800]], [0.1, 112, 0.15, [250, 1000, 2200]],
  [0.1, 112, 0.7, [390, 2000, 2600]], [0.13, 0, 0.2], [0.12, 0, 0],
  [0.17, 120, 1, [740, 1200, 2500]], [0.08, 110, 0.15, [250, 1500, 2400]], [0.07, 0, 0], [0.12, 104, 0.7, [310, 2150, 2900]], [0.14, 96, 0.2, [250, 1500, 2400]], [0.2, 0, 0],
];
// Of the three formants: loudness, and how narrow they are.
const FORMANTS = [[1, 6], [0.6, 9], [0.3, 11]];

// Makes the sentence's sound. Returns what is heard, and its length in seconds.
export function sentence(context) {
  const start = context.currentTime + 0.05;
  const ends = start + SENTENCE.reduce((sum, [seconds]) => sum + seconds, 0);
  const out = new GainNode(context, { gain: 1.6 });
  const voice = new OscillatorNode(context, { type: "sawtooth" });
  const [loud, hiss] = [0, 0].map((gain) => new GainNode(context, { gain }));
  const formants = FORMANTS.map(([gain, Q]) => {
    const filter = new BiquadFilterNode(context, { type: "bandpass", Q });
    voice.connect(filter).connect(new GainNode(context, { gain })).connect(loud);
    return filter;
  });
  loud.connect(out);
  const noise = context.createBuffer(1, context.sampleRate, context.sampleRate);
  // Equal noise at each call.
  let random = 1;
  noise.getChannelData(0).forEach((_, index, all) => (all[index] = (random = Math.imul(random, 48271) | 1) / 2 ** 31));
  const breath = new AudioBufferSourceNode(context, { buffer: noise, loop: true });
  breath.connect(new BiquadFilterNode(context, { type: "highpass", frequency: 3000 })).connect(hiss).connect(out);
  let at = start;
  for (const [seconds, pitch, level, frequencies] of SENTENCE) {
    // Sounds glide into each other.
    const glide = (param, value, time) => param.setTargetAtTime(value, at, time);
    glide(loud.gain, frequencies ? level : 0, 0.012);
    glide(hiss.gain, frequencies ? 0 : level, 0.01);
    if (pitch) glide(voice.frequency, pitch, 0.04);
    frequencies?.forEach((frequency, index) => glide(formants[index].frequency, frequency, 0.02));
    at += seconds;
  }
  for (const source of [voice, breath]) source.start(start), source.stop(ends);
  return [out, ends - context.currentTime];
}

// Calls `heard` with the mouth's weights for what `source` gives; returns the node that listens.
async function listen(context, source, heard) {
  if (context.audioWorklet) {
    await context.audioWorklet.addModule(new URL("talk.js", import.meta.url));
    const node = new AudioWorkletNode(context, "talk", { numberOfOutputs: 1 });
    node.port.onmessage = ({ data }) => heard(data);
    source.connect(node);
    // What leads nowhere may not run.
    node.connect(context.destination);
    return node;
  }
  // Pages that are not served by https have no worklets.
  const [size, talk] = [512, new Talk(context.sampleRate)];
  const node = context.createScriptProcessor(size, 1, 1);
  node.onaudioprocess = ({ inputBuffer }) => {
    talk.push(samplesOf(inputBuffer.getChannelData(0)));
    talk.step(Math.round((1000 * size) / context.sampleRate));
    heard(talk.weights);
  };
  source.connect(node);
  node.connect(context.destination);
  return node;
}

// What a browser's refusal of the microphone means.
const REFUSALS = {
  NotAllowedError: "the browser was not allowed to use the microphone. Its settings for this page allow it",
  NotFoundError: "there is no microphone",
  NotReadableError: "another program uses the microphone",
};

async function microphone() {
  try {
    return await navigator.mediaDevices.getUserMedia({ audio: true });
  } catch (error) {
    throw new Error(REFUSALS[error.name] ?? error.message);
  }
}

// Lets the face of a player speak: by a sentence, or with `isLive` by the microphone, until the sentence ends or `signal` is aborted. `begun` is called when it does, `heard` gets the strongest viseme's name,
// or an empty text. Throws an error with the reason if there is no sound.
export async function speak(player, { isLive, signal, begun, heard }) {
  const stream = isLive ? await microphone() : null;
  let context;
  let request = 0;
  try {
    context = new AudioContext();
    if (context.sampleRate > RATES[1]) {
      await context.close();
      context = new AudioContext({ sampleRate: RATES[1] });
    }
    // Without a sound device some browsers never begin.
    const late = new Promise((_, refuse) => setTimeout(refuse, PATIENCE, new Error("the browser does not begin to play sound; perhaps there is no sound device")));
    await Promise.race([context.resume(), late]);
    if (signal.aborted) return;
    const poses = new Int32Array(NAMES.length);
    let weights = new Array(VISEMES).fill(0);
    await player.load({ rig: rigOf(NAMES), poses, frames: 1, frameTime: 33333333, lengthExponent: 0 });
    const [source, seconds] = isLive ? [context.createMediaStreamSource(stream), Infinity] : sentence(context);
    if (!isLive) source.connect(context.destination);
    await listen(context, source, (all) => (weights = all));
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    let [blink, blinks] = [performance.now() + BLINKS[0], 0];
    const show = (now) => {
      request = requestAnimationFrame(show);
      weights.forEach((weight, index) => (poses[index] = weight * (ONE / 32768)));
      const since = now - blink;
      const lid = since < 0 || still ? 0 : Math.max(0, 1 - Math.abs((2 * since) / BLINK - 1));
      if (since > BLINK) blink = now + BLINKS[++blinks % BLINKS.length];
      poses.fill(lid * ONE, LID, SMILE);
      poses.fill(0.3 * ONE, SMILE);
      player.seek(0);
      const most = Math.max(...weights);
      heard(most > 3000 ? NAMES[weights.indexOf(most)].slice(7) : "");
    };
    show(performance.now());
    begun();
    await new Promise((done) => {
      signal.addEventListener("abort", done);
      stream?.getTracks()[0].addEventListener("ended", done);
      if (signal.aborted) done();
      if (!isLive) setTimeout(done, 1000 * seconds + 200);
    });
  } finally {
    cancelAnimationFrame(request);
    stream?.getTracks().forEach((track) => track.stop());
    await context?.close();
  }
}
