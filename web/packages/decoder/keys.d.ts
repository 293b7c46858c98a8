/** What plays key clips, which hold keys instead of segments. */
export interface Keys {
  check(flags: number, frames: number, states: number): void;
}

/** Pass it to `openClip` or `openBank`, which then open key clips too. It has about 8 KB, and computes all frames when a player is made. */
export const keys: Keys;
