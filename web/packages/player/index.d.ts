/** A marker of a clip that playing passed. */
export interface Heard {
  readonly frame: number;
  readonly id: number;
  readonly name: string;
}

/** Raw poses in place of a clip: a rig, and one value per channel and frame. */
export interface PoseTable {
  rig: Uint8Array;
  poses: Int32Array;
  frames: number;
  /** Nanoseconds. */
  frameTime: number;
  lengthExponent: number;
}

/** What a player is loaded from. */
export type Source = string | URL | Response | ReadableStream<Uint8Array> | Blob | ArrayBuffer | Uint8Array<ArrayBuffer> | PoseTable;

/** Smooth lines, a body with volume, or a display of 128x64 pixels. */
export type Look = "lines" | "solid" | "oled";

/** Numbers of the clip that is loaded; zeros before its first frame has arrived. */
export interface Facts {
  readonly frames: number;
  readonly playable: number;
  readonly frame: number;
  /** Nanoseconds. */
  readonly frameTime: number;
  readonly looped: number;
  readonly channels: number;
  readonly moving: number;
  readonly rigBytes: number;
  readonly motionBytes: number;
  readonly joints: number;
  readonly scalars: number;
}

type Plain =
  | "loadstart" | "durationchange" | "loadedmetadata" | "loadeddata" | "canplay" | "canplaythrough" | "emptied" | "progress" | "play" | "playing" | "pause" | "ended" | "loop"
  | "timeupdate" | "seeked" | "ratechange" | "frame" | "change" | "ready";
interface OwnEventMap extends Record<Plain, CustomEvent<null>> {
  /** What is wrong with the clip; also the property `error`. */
  error: CustomEvent<string>;
  /** A marker of the clip that playing or stepping passed. */
  heard: CustomEvent<Heard>;
  /** A character's new state, by its name. */
  state: CustomEvent<string>;
}

/** The element's events; its own take the place of an element's of the same name. */
export type PantinPlayerEventMap = Omit<HTMLElementEventMap, keyof OwnEventMap> & OwnEventMap;

/** Listeners for the element's own events, as template languages write them: `onended`, `onheard`, ... */
export type PantinPlayerListeners = { [Name in keyof OwnEventMap as `on${Name}`]?: (event: OwnEventMap[Name]) => void };

/** The attributes, as a template language writes them. */
export interface PantinPlayerAttributes {
  src?: string;
  autoplay?: boolean | "";
  loop?: boolean | "";
  loading?: "lazy" | "eager";
  poster?: string;
  crossorigin?: "" | "anonymous" | "use-credentials";
  look?: Look;
  /** With look "solid": the URL of a character, as text or compiled (docs/LOOKS.md). */
  "character-look"?: string;
  speed?: number | string;
  from?: number | string;
  to?: number | string;
  /** The name of the marker with which the part that is played begins; it ends at the next marker. */
  segment?: string;
  fit?: "follow" | "whole";
  align?: "left" | "center" | "right";
  up?: "x" | "y" | "z" | "";
  bare?: boolean | "";
  "aria-label"?: string;
}

/** How a picture is saved. */
export interface PictureOptions {
  /** Pixels; the canvas's width, or 512 of the display, by default. */
  width?: number;
  /** image/png by default; others that the browser writes, such as image/webp. */
  type?: string;
}

/** How a motion is saved. */
export interface RecordOptions {
  /** image/gif by default, video/webm, or another video type that the browser's MediaRecorder knows. */
  type?: string;
  /** Pixels; by default the canvas's width, of a GIF at most 480, or 512 of the display. */
  width?: number;
  /** Pictures per second, at most 50; 25 of a GIF and 30 of a video by default. */
  fps?: number;
  /** Seconds; the element's range by default. */
  from?: number;
  to?: number;
  /** How long a character is recorded; 3 by default. */
  seconds?: number;
  /** Is called after each picture with the part that is done, up to 1. */
  progress?: (part: number) => void;
  signal?: AbortSignal;
}

/** The element <pantin-player>. */
export declare class PantinPlayer extends HTMLElement {
  src: string | null;
  autoplay: boolean;
  loop: boolean;
  look: Look;
  fit: "follow" | "whole";
  /** Where the figure stands in the picture. */
  align: "left" | "center" | "right";
  /** Seconds between which it plays; 0 and Infinity for all of the clip. */
  from: number;
  to: number;
  /** x, y or z; empty for the clip's own. */
  up: string;
  /** The URL of `src`; empty without one. */
  readonly currentSrc: string;
  loading: "lazy" | "eager";
  /** A picture until the first frame is there; an element in the slot `poster` does the same. */
  poster: string;
  crossOrigin: string | null;
  /** The name of the marker with which the part that is played begins; empty for `from` and `to`. */
  segment: string;
  /** A multiple of the clip's own speed. */
  playbackRate: number;
  /** @deprecated The name of `playbackRate` before it was a media element's. */
  speed: number;
  backwards: boolean;
  /** Degrees. */
  orbit: number;
  tilt: number;
  /** Seconds. */
  currentTime: number;
  /** Seconds; NaN without a clip. */
  readonly duration: number;
  readonly frame: number;
  readonly frames: number;
  /** Frames that can be shown already. */
  readonly playable: number;
  readonly paused: boolean;
  readonly ended: boolean;
  /** Whether a frame was asked for that has not arrived. */
  readonly seeking: boolean;
  /** 0 nothing, 1 the clip's numbers, 2 the present frame, 3 frames after it, 4 the whole clip. */
  readonly readyState: 0 | 1 | 2 | 3 | 4;
  /** What is wrong with the clip. */
  readonly error: Error | null;
  /** Bytes. */
  readonly received: number;
  readonly total: number;
  readonly facts: Facts;
  readonly events: readonly Heard[];
  /** Names of a bank's clips. */
  readonly clips: readonly string[];
  /** Names of a state machine's states and inputs, its parameters, and the state that plays; nothing without a state machine. */
  readonly states: readonly string[];
  readonly inputs: readonly string[];
  readonly parameters: readonly { readonly name: string; readonly range: readonly [number, number]; readonly value: number }[];
  readonly state: string | null;
  /**
   * Resolves when all of the clip has arrived. Rejects with what is wrong with it, or with an AbortError if it is given up for another one.
   * `clip` names one of a bank's clips.
   */
  load(what?: Source | null, clip?: string | null): Promise<void>;
  /** Plays. Before a clip has arrived, it waits for it: the promise resolves once the figure moves, and rejects if the clip is no good or is paused before. */
  play(): Promise<void>;
  pause(): void;
  /** Plays what lies between two times in seconds; all of the clip without them. */
  range(from?: number, to?: number): void;
  /** What is shown, as a file. */
  picture(options?: PictureOptions): Promise<Blob>;
  /** The range as an animated GIF or a video. The element shows each picture, then its frame of before. A video takes as long as it lasts. */
  record(options?: RecordOptions): Promise<Blob>;
  /** Fires an input of the state machine once. */
  fire(input: string): void;
  /** Holds an input down, or lets it go. */
  hold(input: string, down?: boolean): void;
  /** Sets a parameter, within its range. */
  set(parameter: string, value: number): void;
  /** Lets a character's time pass, in seconds, as playing does. */
  advance(seconds: number): void;
  /** Shows a frame exactly; one that has not arrived is shown once it has. */
  seek(frame: number): void;
  step(by: number): void;
  /** Orbits and tilts the camera by degrees. */
  turn(orbit: number, tilt: number): void;
  /** The greys of the 128x64 display, in that look alone. */
  grey(): Uint8Array;
  addEventListener<K extends keyof PantinPlayerEventMap>(type: K, listener: (this: PantinPlayer, event: PantinPlayerEventMap[K]) => unknown, options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

declare global {
  interface HTMLElementTagNameMap {
    "pantin-player": PantinPlayer;
  }
}
