/** @jsxImportSource react */
import "@pantin/player/react";
import type { Heard, PantinPlayer } from "@pantin/player/react";
import { useRef } from "react";

export function Walk() {
  const player = useRef<PantinPlayer>(null);
  const heard = ({ detail }: CustomEvent<Heard>) => console.log(detail.name);
  // @ts-expect-error There is no such look.
  const wrong = <pantin-player look="cubes" />;
  return (
    <pantin-player ref={player} src="walk.ptn" look="solid" character-look="cat.look" loop autoplay speed={1.5} style={{ height: 200 }} onheard={heard} onended={() => player.current?.play()}>
      {wrong}
    </pantin-player>
  );
}
