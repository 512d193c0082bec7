// The keys of the task: of the keyboard, those on the page for mouse and finger, and those of a gamepad; and sticks.
//
// The state goes out at every change and, as a sign of life, every 100 ms. When the window loses the focus, is hidden or
// is left, the page says so and falls silent: either makes the human's moment zero.

import { part } from "./parts.js";
import { watchGamepads, watchPull } from "./sticks.js";

const REPEAT_MS = 100;
const NAMES = window.teachPage.keys; // in the order of the buttons
// By what a key means (on a French keyboard A is where others have Q), and by where it is when it types no Latin letter.
const MEANINGS = { ArrowLeft: "left", a: "left", ArrowRight: "right", d: "right", " ": "space", ArrowUp: "up", w: "up",
  ArrowDown: "down", s: "down" };
const PLACES = { KeyA: "left", KeyD: "right", KeyW: "up", KeyS: "down" };

function keyOf(event) {
  const typed = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const name = MEANINGS[typed] ?? (/^[\x20-\x7e]$/.test(typed) ? undefined : PLACES[event.code]);
  const i = NAMES.indexOf(name);
  return i < 0 ? undefined : i;
}

export function listenToKeys(send) {
  const held = NAMES.map(() => new Set()); // by what: a key's code, or a pointer
  let isActive = false;
  let hasFocus = document.hasFocus() && !document.hidden;

  const sticks = [watchPull(() => counts(), () => tell()), watchGamepads(pressed, () => tell())];

  const state = () => held.map((by) => (by.size ? 1 : 0));
  const counts = () => isActive && hasFocus;

  // What is not used is not sent: then the hand is a keyboard.
  function hands() {
    const axes = sticks.map((stick) => stick.axes()).filter((axes) => axes !== null);
    if (!axes.length) return { keys: state() };
    const sum = axes.reduce(([x, y], [dx, dy]) => [x + dx, y + dy]);
    return { keys: state(), axes: sum.map((value) => Math.max(-1, Math.min(value, 1))) };
  }
  function tell() {
    if (counts()) send(hands());
    light();
  }
  function pressed(name, by, isDown) {
    const i = NAMES.indexOf(name);
    if (i < 0 || held[i].has(by) === isDown) return;
    if (isDown) held[i].add(by);
    else held[i].delete(by);
    tell();
  }
  function light() {
    state().forEach((down, i) => key(i).classList.toggle("down", counts() && down === 1));
  }
  function forget() {
    held.forEach((by) => by.clear());
    sticks.forEach((stick) => stick.letGo());
  }
  function letGo() {
    forget();
    if (isActive) send({ let_go: true });
    light();
  }
  function setFocus(has) {
    if (hasFocus && !has) letGo();
    hasFocus = has;
    part("focus").classList.toggle("shown", isActive && !hasFocus);
  }
  const key = (i) => document.querySelector(`[data-key="${NAMES[i]}"]`);

  window.addEventListener("keydown", (event) => {
    const i = keyOf(event);
    if (i === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    if (document.body.classList.contains("over")) return; // links and buttons have them again
    event.preventDefault(); // no scrolling, and no button pressed by the space bar
    setFocus(true); // a key that arrives here proves it
    if (event.repeat) return;
    const by = event.code || event.key; // a remote desktop may give no code
    if (held[i].delete(by)) tell(); // that it was let go has been lost
    held[i].add(by);
    tell();
  }, true);
  window.addEventListener("keyup", (event) => {
    const by = event.code || event.key;
    const released = held.filter((bys) => bys.delete(by)); // with Shift it may mean something else by now
    if (!released.length) return;
    event.preventDefault();
    tell();
  }, true);

  NAMES.forEach((_, i) => {
    key(i).addEventListener("pointerdown", (event) => {
      event.preventDefault();
      key(i).setPointerCapture(event.pointerId);
      held[i].add(event.pointerId);
      tell();
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      key(i).addEventListener(end, (event) => {
        if (held[i].delete(event.pointerId)) tell();
      });
    }
    // Enter on the key, or a screen reader: a click without a pointer.
    key(i).addEventListener("click", (event) => {
      if (event.detail !== 0) return;
      held[i].add("click");
      tell();
      held[i].delete("click");
      tell();
    });
    key(i).addEventListener("contextmenu", (event) => event.preventDefault());
  });

  window.addEventListener("blur", () => setFocus(false));
  window.addEventListener("focus", () => setFocus(true));
  window.addEventListener("pagehide", letGo);
  document.addEventListener("visibilitychange", () => setFocus(!document.hidden && document.hasFocus()));
  setInterval(() => counts() && send(hands()), REPEAT_MS);

  return {
    setActive(active) {
      if (isActive && !active) forget();
      isActive = active;
      setFocus(document.hasFocus() && !document.hidden);
      light();
    },
  };
}
