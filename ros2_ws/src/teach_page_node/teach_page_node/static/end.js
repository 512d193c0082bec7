// The card at the end: what came of the session. It stays when the server has gone.

import { goesOn, lookForTheNextPage } from "./next_page.js";
import { part, setText, show } from "./parts.js";

let stage = null;

export function showEnd({ phase, ending }) {
  if (phase !== "done" && !ending) return;
  const now = ending?.stage ?? "done";
  setText("end-words", words(ending));
  if (now === stage) return;
  stage = now;
  document.body.classList.add("over");
  const isOver = now === "over";
  show("end-report", isOver && ending.has_report);
  show("end-picture", isOver && ending.has_report);
  if (isOver && ending.has_report) part("end-picture").src = "/session/picture.png";
  show("close", isOver);
  if (goesOn) setText("close-text", "Go on");
  if (now === "stopped") lookForTheNextPage();
  if (part("end").hasAttribute("hidden")) {
    show("end", true);
    document.getElementById("end-title").focus();
  }
}

function words(ending) {
  if (!ending) return "The teaching is over.";
  const { stage: now, tested, of, successes } = ending;
  if (goesOn && (now === "stopped" || now === "closed")) return "It goes on here in a moment …";
  if (now === "stopped") return "The session was stopped. Everything so far is kept. You can close this window.";
  if (now === "closed") return "You can close this window.";
  if (now === "testing") return `Testing the robot alone: ${tested} of ${of} …`;
  if (now === "reporting") return "Writing the report …";
  if (successes === null) return goesOn ? "This part is over." : "Everything is kept.";
  const did = window.teachPage.axes.length > 1 ? "brought the ball to the goal" : "kept the ball in the middle";
  return `Your robot alone ${did} in ${successes} of ${of} tests.`;
}

export function listenToEnd(send) {
  part("close").addEventListener("click", () => {
    send({ do: "close" });
    stage = "closed";
    setText("end-words", words({ stage }));
    show("close", false);
    lookForTheNextPage();
  });
}
