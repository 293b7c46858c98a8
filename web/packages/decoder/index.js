// @pantin/decoder: plays clips of character motion (.ptn) and banks of them (.ptb) in plain JavaScript, with the same values as every other decoder of the
// format.
import { LIVE_LINK } from "./names.js";
import { check, openRawBank, openRawClip, openRawRig } from "./clip.js";
import { poseOf } from "./pose.js";

// Indices by names.
const named = (clip) => Object.assign(clip, {
  joint: (name) => {
    const index = clip.joints.findIndex((joint) => name && joint.name === name);
    check(index >= 0, "no joint " + name);
    return index;
  },
  scalar: (name) => {
    const index = clip.scalars.findIndex((scalar) => scalar.name === name);
    check(index >= 0, "no scalar " + name);
    return index;
  },
});
const EXTRAS = { names: LIVE_LINK, named, poseOf };

/** Opens a clip (.ptn). One without a rig needs that of `openRig` or of a bank. With `isPartial`, the bytes are the beginning of a file. Key clips need the `keys` of keys.js. */
const openClip = (data, rig, isPartial, keys) => openRawClip(data, rig, isPartial, { ...EXTRAS, keys });

/** Opens a bank (.ptb), the clips of one rig by name. A bank with key clips needs the `keys` of keys.js. */
const openBank = (data, keys) => openRawBank(data, { ...EXTRAS, keys });

/** Opens a rig that is a file of its own. */
const openRig = (data) => openRawRig(data, LIVE_LINK);

export { openBank, openClip, openRig, poseOf };
