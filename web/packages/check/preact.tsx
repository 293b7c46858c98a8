/** @jsxImportSource preact */
import "@pantin/player/preact";
import { createRef } from "preact";
import type { PantinPlayer } from "@pantin/player/preact";

export function Walk() {
  const player = createRef<PantinPlayer>();
  // @ts-expect-error The ground's sides are x, y and z.
  const wrong = <pantin-player up="w" />;
  return (
    <pantin-player ref={player} src="walk.ptn" segment="step" bare onerror={({ detail }) => console.log(detail.toUpperCase())}>
      {wrong}
    </pantin-player>
  );
}
