// Replay: play, pause, slider with marks of the episodes, speed.

import { part, setText } from "./parts.js";

const JUMP = 5; // s
const AT_ONCE = 0.3; // s: the episode that has just begun is not the one before
const NEAREST = 0.035; // of the slider, between two marks that have room for their names
const SIGNS = { success: "✓", failure: "✗" }; // of a person's verdict; what was discarded is struck out

const marks = window.teachPage.marks;
let replay = { position: 0, length: 1, speed: 1, plays: false };
let isDragging = false;
let markedLength = null;

export function listenToPlayer(send) {
  const slider = part("slider");
  const seek = (seconds) => send({ do: "seek", value: seconds });
  const play = () => send({ do: "play", value: !replay.plays });
  part("play").addEventListener("click", play);
  part("previous").addEventListener("click", () => seek(marks.findLast(([at]) => at < replay.position - AT_ONCE)?.[0] ?? 0));
  part("next").addEventListener("click", () => seek(marks.find(([at]) => at > replay.position + 0.01)?.[0] ?? replay.length));
  part("speed").addEventListener("change", (event) => send({ do: "speed", value: Number(event.target.value) }));
  slider.addEventListener("pointerdown", () => (isDragging = true));
  slider.addEventListener("pointerup", () => (isDragging = false));
  slider.addEventListener("input", () => seek(Number(slider.value)));
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === " ") play();
    else if (event.target instanceof HTMLSelectElement) return; // arrows choose the speed there
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
  if (markedLength !== replay.length) drawMarks();
  if (!isDragging) slider.value = replay.position;
  slider.setAttribute("aria-valuetext", `${clock(replay.position)}, ${part("phase").textContent}`);
  setText("play-text", replay.plays ? "Pause" : "Play");
  setText("position", `${clock(replay.position)} / ${clock(replay.length)}`);
  const speed = part("speed");
  if (document.activeElement !== speed) speed.value = String(replay.speed);
}

function drawMarks() {
  markedLength = replay.length;
  let named = -1;
  part("marks").replaceChildren(...marks.map(([at, name, verdict]) => {
    const mark = document.createElement("span");
    const where = at / replay.length;
    mark.style.left = `${100 * where}%`;
    mark.classList.toggle("test", name.startsWith("T"));
    mark.title = `episode ${name}${verdict && `: ${verdict === "discard" ? "discarded" : verdict}`}`;
    mark.dataset.verdict = verdict;
    const hasRoom = where - named >= NEAREST;
    mark.textContent = hasRoom ? name + (SIGNS[verdict] ?? "") : "\u00a0";
    if (hasRoom) named = where;
    return mark;
  }));
}

// Joint states are kept every 10 ms: a recording of 12 s ends a little before that.
const clock = (seconds) => {
  const whole = Math.floor(seconds + 0.05);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
};
