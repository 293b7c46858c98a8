// A table of raw poses in place of a clip: a rig, and one value per channel and frame.
export function tableOf({ rig: bytes, poses, frames, frameTime, lengthExponent }, openRig) {
  const rig = openRig(bytes);
  const { joints, scalars, channels } = rig;
  if (!frames || poses.length < frames * channels) throw new Error("the table ends early");
  const clip = { rig, joints, scalars, events: [], frames, frameTimeNs: frameTime, exponent: lengthExponent, looped: false };
  const player = {
    clip,
    frame: 0,
    raw: poses.subarray(0, channels),
    seek(frame) {
      player.frame = Math.max(0, Math.min(frame, frames - 1));
      player.raw = poses.subarray(player.frame * channels, (player.frame + 1) * channels);
      return player;
    },
  };
  return player;
}
