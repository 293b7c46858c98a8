import "@pantin/player/react";
import type { PantinPlayer } from "@pantin/player/react";
import { useRef, useState } from "react";

export function Walk() {
  const player = useRef<PantinPlayer>(null);
  const [rounds, setRounds] = useState(0);
  const [isPaused, setPaused] = useState(false);
  return (
    <main>
      <pantin-player
        ref={player} src="walk.ptn" autoplay loop
        onloop={() => setRounds((rounds) => rounds + 1)}
        onplay={() => setPaused(false)} onpause={() => setPaused(true)}
      />
      <button onClick={() => (isPaused ? player.current?.play() : player.current?.pause())}>{isPaused ? "Play" : "Pause"}</button>
      <output>{rounds}</output>
    </main>
  );
}
