// Words and numbers: phase, time, moments, role, connection.

import { part, setText, show } from "./parts.js";

const PHASES = {
  wait: ["Getting ready", "Waiting for the robot …"],
  practice: ["Practice", "The robot is off: you alone move the tray. Get the feel, then start teaching."],
  teach: ["Teach", "The robot tries; correct it with the keys."],
  learn: ["It learns", "The robot learns from your corrections …"],
  test: ["The robot alone", "Hands off: watch how it does without you."],
  done: ["Finished", "The lesson is over. The report is where the session was started."],
};
const NOBODY = ["No lesson", "Nobody learns at the moment; your keys move the tray."];

let phase = null;
let role = { teaches: false, seat_is_free: false };

export function showPicture(picture, isReplay) {
  phase = picture.phase;
  const [title, doing] = PHASES[phase] ?? (isReplay ? ["Replay", ""] : NOBODY);
  const isEpisode = phase === "teach" || phase === "test";
  setText("phase", isEpisode && picture.episode !== null ? `${title} · episode ${picture.episode}` : title);
  part("phase").className = `phase ${phase ?? "none"}`;
  setText("doing", trouble(picture, isReplay) ?? (isReplay ? "A recorded session." : picture.notice || doing));
  part("doing").classList.toggle("trouble", trouble(picture, isReplay) !== null);

  const left = isEpisode && picture.time_left !== null ? Math.max(picture.time_left, 0) : null;
  setText("time-left", left === null ? "" : `${left.toFixed(0)} s left`);
  part("time-bar").style.width = left === null ? "0" : `${Math.min(100, (100 * left) / window.teachPage.episode_seconds[phase])}%`;
  setText("success", picture.success === null ? "not yet" : `${Math.round(100 * picture.success)} % ${window.teachPage.axes.length > 1 ? "at the goal" : "kept in the middle"}`);
  setText("human-name", picture.hand === "tutor" ? "simulated tutor" : role.teaches && !isReplay ? "you" : "human");
  for (const name of ["human", "agent", "applied"]) setText(`${name}-moment`, moment(picture[name]));
  if (isReplay) return;
  for (const [i, name] of window.teachPage.keys.entries()) {
    document.querySelector(`[data-key="${name}"]`).classList.toggle("lit", picture.keys[i] === 1);
  }
  setText("pause", picture.paused ? "Go on" : "Pause");
  document.body.classList.toggle("keys-rest", phase !== null && phase !== "practice" && phase !== "teach");
  showButtons();
}

function trouble(picture, isReplay) {
  if (isReplay) return null;
  if (picture.paused) return "Paused.";
  if (picture.q === null) return "No robot is to be heard yet …";
  if (picture.silent_for !== null && phase !== "learn") return "The robot stands still.";
  return null;
}

const signed = (value) => `${value > 0 ? "+" : value < 0 ? "−" : ""}${Math.abs(value).toFixed(1)}`;
const SIGNS = { 3: ["↑", "↓"], 4: ["←", "→"] }; // where a moment about base x (3) or y (4) rolls the ball

function moment(values) {
  if (values === null) return "–";
  if (values.length === 1) return signed(values[0]);
  return values.map((value, i) => `${value === 0 ? "" : SIGNS[window.teachPage.axes[i]][value > 0 ? 0 : 1]}${Math.abs(value).toFixed(1)}`).join(" ");
}

export function showRole(newRole, isReplay) {
  role = newRole;
  const watchers = role.watchers ? `, ${role.watchers} watching` : "";
  setText("role", isReplay ? "" : role.teaches ? `you teach${watchers}` : role.seat_is_free ? "nobody teaches" :
    "you watch: another page teaches");
  document.body.classList.toggle("watching", !role.teaches);
  if (!isReplay) showButtons();
}

function showButtons() {
  show("take-seat", !role.teaches && role.seat_is_free);
  show("start", role.teaches && phase === "practice");
  show("repeat", role.teaches && (phase === "teach" || phase === "test"));
  show("finish", role.teaches && (phase === "teach" || phase === "learn"));
  show("pause", role.teaches);
  show("stop", role.teaches);
}

export function showConnection(isUp) {
  document.body.classList.toggle("offline", !isUp);
  if (isUp) return;
  setText("role", "not connected");
  setText("phase", phase === "done" ? "Finished" : "No connection");
  part("phase").className = "phase none";
  setText("doing", phase === "done" ? PHASES.done[1] :
    "The session has ended, or the connection is lost; your moment is zero. Trying again …");
}
