// Short programs that play a clip: `stem` names its files, `header` is its C header.
export function programs(stem, header) {
  const [, name] = /#define (CLIP_\w+)_LEN /.exec(header);
  const number = (what) => new RegExp(`#define ${name}_${what} (\\d+)`).exec(header)[1];
  return [
    {
      language: "Web page",
      needs: `Put pantin-player.js, the other pantin-*.js and ${stem}.ptn beside the page.`,
      text: `<script type="module" src="pantin-player.js"></script>\n<pantin-player src="${stem}.ptn" autoplay loop></pantin-player>`,
    },
    {
      language: "JavaScript",
      needs: "npm package @pantin/decoder",
      text: `import { openClip } from "@pantin/decoder";

const clip = openClip(await (await fetch("${stem}.ptn")).arrayBuffer());
const player = clip.play();
do {
  console.log(player.frame, player.world()); // x, y and z of each joint
} while (player.step());`,
    },
    {
      language: "C",
      needs: `bindings/c/src/pantin.c, and ${stem}.h by \u201cSave C header\u201d`,
      text: `#include <stdio.h>
#include "pantin.h"
#include "${stem}.h"

static int32_t pose[${name}_CHANNELS];
static pantin_channel moving[${name}_MOVING];

int main(void) {
  pantin_source source;
  pantin_clip clip;
  pantin_player player;
  pantin_memory(&source, ${name}, ${name}_LEN);
  if (pantin_open(&clip, &source, NULL) != PANTIN_OK) return 1;
  if (pantin_start(&player, &clip, pose, ${name}_CHANNELS, moving, ${name}_MOVING) != PANTIN_OK) return 1;
  do {
    printf("frame %lu: channel 0 is %ld\\n", (unsigned long)player.frame, (long)pose[0]);
  } while (pantin_step(&player) == PANTIN_OK);
  return 0;
}`,
    },
    {
      language: "Arduino",
      needs: `The library in pantin-arduino.zip, and ${stem}.h by \u201cSave C header\u201d`,
      text: `#include <PantinPlayer.h>
#include "${stem}.h"

PantinPlayer<${name}_CHANNELS> player;

void setup() {
  Serial.begin(115200);
  player.begin(${name}, ${name}_LEN);
}

void loop() {
  if (player.update(millis())) Serial.println(player.frame());
}`,
    },
    {
      language: "Rust",
      needs: "crate pantin",
      text: `use pantin::{Clip, Room};

static CLIP: &[u8] = include_bytes!("${stem}.ptn");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let clip = Clip::new_checked(CLIP)?;
    let mut room = Room::<${number("MOVING")}, ${number("CHANNELS")}>::new();
    let mut player = room.player(clip)?;
    for frame in 0..clip.frames() {
        println!("frame {frame}: {:?}", player.pose());
        player.step();
    }
    Ok(())
}`,
    },
    {
      language: "Python",
      needs: "package pantin",
      text: `import pantin

clip = pantin.Clip.open("${stem}.ptn")
positions = clip.positions()  # (frames, joints, 3), in cm
print(positions.shape, clip.joints[0].name, positions[0, 0])`,
    },
    {
      language: "MicroPython",
      needs: `bindings/micropython/pantin*.py and ${stem}.ptn on the board`,
      text: `import pantin

clip = pantin.Clip(open("${stem}.ptn", "rb").read())
while True:
    print(clip.frame, list(clip.pose))
    if not clip.step():
        break`,
    },
  ];
}
