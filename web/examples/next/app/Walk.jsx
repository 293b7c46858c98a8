"use client";
import "@pantin/player/react";
import { useEffect, useRef, useState } from "react";

// React attaches no listeners of its own to elements that a server has rendered.
export function Walk() {
  const player = useRef(null);
  const [rounds, setRounds] = useState(0);
  const [isPaused, setPaused] = useState(false);
  useEffect(() => {
    const listening = new AbortController();
    const listen = (event, listener) => player.current.addEventListener(event, listener, { signal: listening.signal });
    listen("loop", () => setRounds((rounds) => rounds + 1));
    listen("play", () => setPaused(false));
    listen("pause", () => setPaused(true));
    return () => listening.abort();
  }, []);
  return (
    <>
      <pantin-player ref={player} src="/walk.ptn" autoplay loop />
      <button onClick={() => (isPaused ? player.current.play() : player.current.pause())}>{isPaused ? "Play" : "Pause"}</button>
      <output>{rounds}</output>
    </>
  );
}
