// Replay: play, hold, slider, speed.

import { part, setText } from "./parts.js";

const JUMP = 5; // s

let replay = { position: 0, length: 1, speed: 1, plays: false };
let isDragging = false;

export function listenToPlayer(send) {
  const slider = part("slider");
  const seek = (seconds) => send({ do: "seek", value: seconds });
  const play = () => send({ do: "play", value: !replay.plays });
  part("play").addEventListener("click", play);
  part("speed").addEventListener("change", (event) => send({ do: "speed", value: Number(event.target.value) }));
  slider.addEventListener("pointerdown", () => (isDragging = true));
  slider.addEventListener("pointerup", () => (isDragging = false));
  slider.addEventListener("input", () => seek(Number(slider.value)));
  window.addEventListener("keydown", (event) => {
    if (event.key === " ") play();
    else if (event.key === "ArrowLeft") seek(replay.position - JUMP);
    else if (event.key === "ArrowRight") seek(replay.position + JUMP);
    else return;
    event.preventDefault();
  }, true);
}

export function showPlayer(newReplay) {
  replay = newReplay;
  const slider = part("slider");
  if (Number(slider.max) !== replay.length) slider.max = replay.length;
  if (!isDragging) slider.value = replay.position;
  setText("play", replay.plays ? "Hold" : "Play");
  setText("position", `${clock(replay.position)} / ${clock(replay.length)}`);
  const speed = part("speed");
  if (document.activeElement !== speed) speed.value = String(replay.speed);
}

// Joint states are kept every 10 ms: a recording of 12 s ends a little before that.
const clock = (seconds) => {
  const whole = Math.floor(seconds + 0.05);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
};
