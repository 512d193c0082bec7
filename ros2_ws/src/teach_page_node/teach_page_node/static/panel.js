// Words and numbers: phase, time, moments, role, connection, and the card between two episodes.

import { part, setText, show } from "./parts.js";

const { words, keys, pushes, keystroke } = window.teachPage;
const COUNT = [null, "practice", "teach"]; // phases in which keys count
const ANSWER_MS = 4000;
const SOON_MS = 2000; // a button that has just come is no target yet

let phase = null;
let role = { teaches: false, seat_is_free: false };
let phaseSince = 0;
let paused = false;
let asked = null; // what was asked for and is not there yet: pause or go on, until when
let asksWhetherDone = false;
let mayStart = false;

export function showPicture(picture, isReplay) {
  if (picture.phase !== phase) {
    phase = picture.phase;
    phaseSince = performance.now();
    if (phase !== "teach" && phase !== "learn") asksWhetherDone = false;
  }
  paused = picture.paused;
  const [title, doing] = words[phase] ?? (isReplay ? ["Replay", ""] : words.nothing);
  const isEpisode = phase === "teach" || phase === "test";
  setText("phase", isEpisode && picture.episode !== null ? `${title} · episode ${picture.episode}` : title);
  part("phase").className = `phase ${phase ?? "none"}`;
  showDoing(picture, doing, isReplay);
  showCard(picture);

  const left = isEpisode && !isStuck(picture) && picture.time_left !== null ? Math.max(picture.time_left, 0) : null;
  setText("time-left", left === null ? "" : `${left.toFixed(0)} s left`);
  part("time-bar").parentElement.hidden = left === null;
  part("time-bar").style.width = left === null ? "0" : `${Math.min(100, (100 * left) / picture.episode_seconds)}%`;
  if (isReplay && picture.success !== null && !window.teachPage.tested) setText("success", `${Math.round(100 * picture.success)} % ${window.teachPage.axes.length > 1 ? "at the goal" : "kept in the middle"}`);
  show("score", isReplay && part("success").textContent !== "");
  setText("human-name", picture.hand === "tutor" ? "simulated tutor" : role.teaches && !isReplay ? "you" : "human");
  showMoments(picture);
  if (isReplay) return;
  showKeys(picture);
  showButtons(picture);
}

const isStuck = (picture) => picture.silent_for !== null && picture.silent_for > window.teachPage.stuck_seconds && !picture.paused;

function showDoing(picture, doing, isReplay) {
  const [kind, text] = isReplay ? ["", phase === null ? "" : viewersWords()] : says(picture, doing);
  setText("doing", text);
  const line = part("doing");
  line.classList.toggle("trouble", kind === "trouble");
  const live = kind === "trouble" ? "assertive" : "polite";
  if (line.getAttribute("aria-live") !== live) line.setAttribute("aria-live", live);
}

function viewersWords() {
  return { practice: "The person alone moved the tray.", teach: "The person and the robot pushed together.",
    learn: "The robot learned from the episode.", test: "The robot was alone.", wait: "A break before an episode.",
    done: "The end of the teaching." }[phase] ?? "";
}

function says(picture, doing) {
  if (picture.ending && phase === "done") return ["", doing];
  if (asked && performance.now() < asked.until && asked.paused !== picture.paused) return ["", asked.paused ? "Pausing …" : "Going on …"];
  asked = null;
  if (picture.paused) return ["", "Paused: everything waits, and keys do not count."];
  if (picture.q === null) return ["trouble", picture.notice || "Waiting for the robot …"];
  if (picture.silent_for !== null && (phase === "teach" || phase === "test" || phase === "practice")) {
    return ["trouble", isStuck(picture) ? window.teachPage.stuck.replace("{seconds}", picture.silent_for.toFixed(0)) : window.teachPage.stands_still];
  }
  if (!role.teaches) return ["", role.seat_is_free ? "You are watching. Nobody teaches." : "You are watching: another page teaches."];
  return ["", picture.notice || (phase === "practice" ? window.teachPage.practice[picture.rests_left] : doing)];
}

// How the episode ended, while the robot learns and until the next one begins.
function showCard(picture) {
  const isBetween = (phase === "learn" || phase === "wait") && !picture.paused;
  const outcome = isBetween ? picture.outcome : null;
  const countdown = `Next in ${Math.max(1, Math.ceil(picture.next_in))} …`;
  const next = !isBetween || picture.next_in === null ? "" : picture.ends_teaching ? "Now the robot is tested." : countdown;
  setText("card-outcome", outcome ? `${outcome.is_good ? "✓ " : ""}${outcome.words}` : "");
  setText("card-next", next || (phase === "learn" && isBetween ? "The robot is learning …" : ""));
  part("card").classList.toggle("good", Boolean(outcome?.is_good));
  show("card", isBetween && (outcome !== null || next !== ""));
}

const round = (value) => Math.round(10 * value) / 10;
const signed = (value) => `${value > 0 ? "+" : value < 0 ? "−" : ""}${Math.abs(value).toFixed(1)}`;
const SIGNS = { 3: ["↑", "↓"], 4: ["←", "→"] }; // where a moment about base x (3) or y (4) rolls the ball

// As rounded they add up, too: the robot's is what the other two leave, unless the sum is at its limit.
function showMoments({ human, agent, applied }) {
  const isWhole = human !== null && agent !== null && applied !== null;
  const shown = { human: human?.map(round), applied: applied?.map(round), agent: agent?.map((value, i) => {
    const rest = isWhole ? round(round(applied[i]) - round(human[i])) : value;
    return Math.abs(rest - value) < 0.15 ? rest : round(value);
  }) };
  for (const [name, values] of Object.entries(shown)) setText(`${name}-moment`, values === undefined ? "–" : moment(values));
  const isLimited = isWhole && applied.some((value, i) => Math.abs(human[i] + agent[i] - value) > 0.15);
  setText("applied-name", isLimited ? "together (limit)" : "together");
}

function moment(values) {
  if (values.length === 1) return signed(values[0]);
  return values.map((value, i) => `${value === 0 ? "" : SIGNS[window.teachPage.axes[i]][value > 0 ? 0 : 1]}${Math.abs(value).toFixed(1)}`).join(" ");
}

// What each key has added, and that it stays.
function showKeys({ asked: push, keys: lit, paused: isPaused }) {
  const counts = COUNT.includes(phase) && !isPaused;
  document.body.classList.toggle("keys-rest", !counts);
  let most = 0;
  for (const [i, name] of keys.entries()) {
    const key = document.querySelector(`[data-key="${name}"]`);
    key.classList.toggle("lit", lit[i] === 1);
    if (!(name in pushes)) continue;
    const [axis, sign] = pushes[name];
    const notches = push === null ? 0 : Math.max(0, Math.round((sign * push[axis]) / keystroke));
    most = Math.max(most, notches);
    key.querySelectorAll(".notches i").forEach((notch, n) => notch.classList.toggle("on", n < notches));
  }
  setText("push", !counts ? "Your keys do not count now." : most ? "Your push stays. Space takes it away." : "No push.");
}

export function showRole(newRole, isReplay) {
  role = newRole;
  const watchers = role.watchers ? `, ${role.watchers} watching` : "";
  setText("role", isReplay ? "" : role.teaches ? `you teach${watchers}` : role.seat_is_free ? "nobody teaches" :
    "you watch: another page teaches");
  document.body.classList.toggle("watching", !role.teaches);
}

function showButtons(picture) {
  const isTaught = phase === "teach" || phase === "learn";
  const canFinish = role.teaches && isTaught;
  show("take-seat", !role.teaches && role.seat_is_free);
  show("start", role.teaches && phase === "practice" && !picture.rests_left);
  mayStart = phase === "practice" && role.teaches && !picture.rests_left;
  show("repeat", role.teaches && phase !== "done");
  part("repeat").disabled = picture.paused || !(phase === "teach" || phase === "test");
  show("pause", role.teaches && phase !== "done");
  setText("pause-text", picture.paused ? "Go on" : "Pause");
  show("stop", role.teaches && phase !== "done");
  showVerdict(picture);
  show("ending", canFinish && picture.ends_teaching);
  show("sure", canFinish && !picture.ends_teaching && asksWhetherDone);
  show("finish", canFinish && !picture.ends_teaching && !asksWhetherDone);
  part("finish").classList.toggle("soon", isTooSoon());
}

// What a person may say of the last episode that has ended, and has said.
function showVerdict({ ended, verdict }) {
  if (!window.teachPage.verdicts) return;
  show("judge", role.teaches && ended !== null);
  if (ended === null) return;
  setText("judged", `${ended[0] === "test" ? "Test" : "Episode"} ${ended[1]}`);
  for (const name of ["success", "failure", "discard"]) part(`judge-${name}`).setAttribute("aria-pressed", String(verdict === name));
  part("judge-discard").disabled = ended[0] === "test";
}

// A second click, meant for what stood there before, is none on what stands there now.
export const isTooSoon = () => performance.now() - phaseSince < SOON_MS && phase === "teach";

export function askWhetherDone(asks) {
  asksWhetherDone = asks;
  show("sure", asks); // at once: the focus is to go there
  show("finish", !asks);
}

export function askToPause() {
  asked = { paused: !paused, until: performance.now() + ANSWER_MS };
}

export const canStart = () => mayStart;
export const isAsking = () => asksWhetherDone;

export function showConnection(isUp) {
  document.body.classList.toggle("offline", !isUp);
  if (isUp) return;
  setText("role", "not connected");
  if (phase === "done" || document.body.classList.contains("over")) return;
  setText("phase", "No connection");
  part("phase").className = "phase none";
  setText("doing", "The session has ended, or the connection is lost; there is no push. Trying again …");
}
