// The buttons of the lesson, and the keys that press some of them: p pauses, Enter begins to teach, g, b and x judge.

import { askToPause, askWhetherDone, canStart, isAsking, isTooSoon } from "./panel.js";
import { part } from "./parts.js";

const VERDICTS = window.teachPage.verdicts ? { g: "success", b: "failure", x: "discard" } : {}; // those that are offered
const SETTLE_MS = 700; // a question that has just come is not answered by a second click

export function listenToButtons(send) {
  let askedAt = -Infinity;
  const on = (name, act) => part(name).addEventListener("click", act);
  const say = (name) => () => send({ do: name });
  const ask = (asks) => {
    askedAt = performance.now();
    askWhetherDone(asks);
  };
  const isSettled = () => performance.now() - askedAt > SETTLE_MS;
  const pause = () => {
    askToPause();
    send({ do: "pause" });
  };

  for (const verdict of Object.values(VERDICTS)) on(`judge-${verdict}`, () => send({ do: "judge", value: verdict }));

  on("start", say("start"));
  on("take-seat", say("take_seat"));
  on("repeat", say("repeat"));
  on("keep-teaching", say("keep_teaching"));
  on("pause", pause);
  on("finish", () => {
    if (isTooSoon() || !isSettled()) return;
    ask(true);
    part("no").focus();
  });
  on("no", () => isSettled() && ask(false));
  on("yes", () => {
    if (!isAsking() || !isSettled()) return;
    ask(false);
    send({ do: "finish" });
  });
  on("stop", () => {
    if (confirm("Stop the session now? Everything so far is kept.")) send({ do: "stop" });
  });

  window.addEventListener("keydown", (event) => {
    if (event.repeat || event.ctrlKey || event.altKey || event.metaKey || document.body.classList.contains("watching")) return;
    const verdict = VERDICTS[event.key.toLowerCase()];
    if (verdict) send({ do: "judge", value: verdict });
    else if (event.key.toLowerCase() === "p") pause();
    else if (event.key === "Enter" && document.activeElement === document.body && canStart()) send({ do: "start" });
  });
}
