import { openClip } from "@pantin/decoder";
import "@pantin/player";
import { PantinPose } from "@pantin/three";

Object.assign(window, { openClip, PantinPose });
