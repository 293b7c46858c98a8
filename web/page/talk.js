// Lips for speech: the firmware's module pantin_face::talk in JavaScript, with the same integers bit for bit, without visemes that a speech engine names. That module
// explains the steps and states the bounds by which all products fit 32 bits. In an audio worklet this script is the processor `talk`.

// The lowest and the highest rate of sound, in Hz.
export const RATES = [8000, 48000];
const BAND_RATE = 8000;
const HOP = 80;
const TICK_MS = 10;
const SILENT_MS = 150;
const LOWEST_HOPS = 80;
const SOFTEST = 2500;
const LOUDEST = 8192;
const ABOVE_NOISE = 448;
const SPEECH_ABOVE_NOISE = 1200;
const RESONATORS = [[862, 384], [774, 384], [627, 384], [339, 384], [-139, 384], [-655, 320]];
const RECIPROCALS = [0, 4096, 2048, 1365, 1024, 819, 683];
const FULL = 1 << 15;
const VISEMES = 14;

const { abs, clz32, max, min, trunc } = Math;
const logarithm = (sum) => {
  const bits = 31 - clz32(max(sum, 1));
  return bits * 256 + ((bits < 8 ? sum << (8 - bits) : sum >>> (bits - 8)) & 255);
};
// A weight that grows from 0 at `none` to its full at `full`.
const ramp = (level, none, full) => trunc((max(0, min(level - none, full - none)) * FULL) / (full - none));
const part = (weight, of) => (weight * of) >>> 15;

// A mouth that speaks, for sound of `rate` samples a second. `weights` are those of MPEG-4's visemes 1 to 14, 0 to 32768.
export class Talk {
  weights = new Array(VISEMES).fill(0);
  targets = new Array(VISEMES).fill(0);
  phase = 0;
  sum = 0;
  count = 0;
  mean = 0;
  before = [0, 0];
  bands = RESONATORS.map(() => [0, 0]);
  levels = RESONATORS.map(() => 0);
  samples = 0;
  lowest = [LOUDEST, 0];
  hops = 0;
  loudest = 0;
  rest = 0;
  silent = 0;

  constructor(rate) {
    this.rate = rate;
  }

  // Listens to samples of 16 bits.
  push(samples) {
    if (samples.length) this.silent = 0;
    for (const sample of samples) {
      this.sum += sample;
      this.count++;
      this.phase += BAND_RATE;
      if (this.phase < this.rate) continue;
      this.phase -= this.rate;
      this.sample((this.sum * (RECIPROCALS[this.count] ?? 0)) >> 12);
      this.sum = this.count = 0;
    }
  }

  // Lets milliseconds pass. The mouth closes if no samples came for 150 ms.
  step(ms) {
    for (this.rest += ms; this.rest >= TICK_MS; this.rest -= TICK_MS) {
      this.silent = min(SILENT_MS, this.silent + TICK_MS);
      if (this.silent < SILENT_MS) continue;
      this.targets.fill(0);
      this.approach();
    }
  }

  // Takes up one sample at 8 kHz.
  sample(whole) {
    const { before, bands, levels } = this;
    this.mean += (whole * 16 - this.mean) >> 4;
    const sample = whole * 16 - this.mean;
    const driven = (sample - before[1]) >> 3;
    this.before = [sample, before[0]];
    RESONATORS.forEach(([turn, decay], index) => {
      const band = bands[index];
      const now = driven + ((turn * band[0] - decay * band[1]) >> 9);
      bands[index] = [now, band[0]];
      levels[index] += abs(now) >> 4;
    });
    if (++this.samples < HOP) return;
    this.samples = 0;
    this.listen(levels.map((sum) => logarithm(sum + HOP)));
    levels.fill(0);
    this.approach();
  }

  // The mouth's targets by the levels of a hop.
  listen([l300, l650, l1000, l1500, l2200, l3200]) {
    this.targets.fill(0);
    const open = max(l650, l1000);
    const voice = max(open, l300);
    if (!this.audible(max(voice, l3200), open)) return;
    const hiss = ramp(l3200 - voice, -150, 100);
    const wide = part(ramp(l650 - l300, -300, -100), FULL - hiss);
    const narrow = FULL - hiss - wide;
    const jaw = part(wide, ramp(open - this.loudest, -750, -150));
    const front = ramp(l2200 - l1000, -470, -310);
    const e = part(jaw, front);
    const o = part(jaw, part(ramp(l300 - l1000, 80, 220), FULL - front));
    const loud = part(narrow, ramp(voice - this.loudest, -420, -235));
    const u = part(loud, ramp(l1500 - l2200, -40, 120));
    const ss = part(hiss, ramp(l3200 - this.loudest, -1100, -700));
    this.targets = [0, 0, 0, 0, 0, 0, ss, 0, 0, jaw - e - o, e, loud - u, o, u];
  }

  // Follows the lowest and the loudest level. Whether a hop of such levels is louder than noise.
  audible(all, open) {
    const { lowest } = this;
    lowest[0] = min(lowest[0], all);
    const noise = max(min(...lowest), SOFTEST);
    if (++this.hops === LOWEST_HOPS) {
      this.hops = 0;
      this.lowest = [all, lowest[0]];
    }
    if (open > this.loudest) this.loudest += (open - this.loudest + 3) >> 2;
    else this.loudest -= this.hops & 1;
    this.loudest = max(this.loudest, noise + SPEECH_ABOVE_NOISE);
    return all >= noise + ABOVE_NOISE;
  }

  // A step of all weights towards their targets: half of the way, and five eighths where a weight falls.
  approach() {
    this.weights = this.weights.map((weight, index) => {
      const rest = this.targets[index] - weight;
      return weight + ((rest < 0 ? -((-rest * 5) >> 3) : rest >> 1) || rest);
    });
  }
}

// Sound between -1 and 1 as samples of 16 bits.
export const samplesOf = (sound) => Array.from(sound, (value) => max(-32768, min(Math.round(value * 32768), 32767)));

// Parts of 10 ms or a little more: weights change no more often.
if (globalThis.AudioWorkletProcessor) {
  registerProcessor("talk", class extends AudioWorkletProcessor {
    talk = new Talk(sampleRate);
    elapsed = 0;
    process([[sound]]) {
      if (sound) this.talk.push(samplesOf(sound));
      this.elapsed += 128000;
      const ms = trunc(this.elapsed / sampleRate);
      if (ms < TICK_MS) return true;
      this.elapsed -= ms * sampleRate;
      this.talk.step(ms);
      this.port.postMessage(this.talk.weights);
      return true;
    }
  });
}
