// The tray and the moments as arrows, from the front or, with two axes, from above. Base +x, to which a positive moment
// about y rolls the ball, is on the left; -y, to which a positive moment about x rolls it, at the top.

import { part, setText } from "./parts.js";

const EXAGGERATION = 3;
const STEEPEST = 20; // degrees that are drawn: the raised end stays in the picture
const LOWEST = 45; // where a ball that falls is lost to sight
const MM = 1000; // 1 mm is a unit of the drawing
const ARROWS = 200; // units of the drawing for the task's largest moment
const HEAD = 16;
// From the front the arrows stand below each other.
const ROWS = window.teachPage.axes.length > 1 ? { human: 0, agent: 0, applied: 0 } : { human: 85, agent: 102, applied: 120 };

export function showCloseView(picture) {
  const isFromAbove = window.teachPage.axes.length > 1;
  if (isFromAbove) showFromAbove(picture);
  else showFromFront(picture);
  const [human, agent, applied] = [picture.human, picture.agent, picture.applied].map(inPicture);
  const sum = [human[0] + agent[0], human[1] + agent[1]];
  arrow("human", [0, 0], human);
  arrow("agent", human, sum);
  arrow("applied", [0, 0], applied);
}

// A moment as it points in the drawing: to where it rolls the ball, N m.
function inPicture(moment) {
  const to = [0, 0];
  moment?.forEach((value, i) => (to[window.teachPage.axes[i] === 4 ? 0 : 1] -= value));
  return to;
}

function showFromAbove({ on_tray, tilt }) {
  const { half_length, half_width, goal } = window.teachPage;
  const degrees = ((tilt ?? 0) * 180) / Math.PI;
  part("close-ball").style.display = on_tray === null ? "none" : "";
  if (on_tray === null) return setText("tilt-text", "");
  const [x, y] = [[on_tray[0], half_length], [on_tray[1], half_width]].map(([at, half]) => Math.max(-half - 0.02, Math.min(half + 0.02, at)));
  part("close-ball").setAttribute("cx", (-x * MM).toFixed(1));
  part("close-ball").setAttribute("cy", (y * MM).toFixed(1));
  const off = 100 * Math.hypot(on_tray[0] - goal[0], on_tray[1] - goal[1]);
  setText("tilt-text", `from above · tilt ${degrees.toFixed(1)}° · ${off.toFixed(1)} cm to go`);
}

function showFromFront({ on_tray, pitch }) {
  const degrees = ((pitch ?? 0) * 180) / Math.PI;
  const drawn = Math.max(-STEEPEST, Math.min(STEEPEST, EXAGGERATION * degrees));
  part("tilt").setAttribute("transform", `rotate(${(-drawn).toFixed(2)})`);
  const side = degrees > 0 ? "to the left" : "to the right";
  setText("tilt-text", pitch === null ? "" : Math.abs(degrees) < 0.05 ? "level" :
    `tilt ${Math.abs(degrees).toFixed(1)}° ${side}${Math.abs(drawn) < STEEPEST ? ` (drawn ${EXAGGERATION} ×)` : ""}`);

  const { half_length, surface } = window.teachPage;
  const isNear = on_tray !== null && Math.abs(on_tray[0]) < half_length + 0.09;
  for (const name of ["close-ball", "close-shadow"]) part(name).style.display = isNear ? "" : "none";
  if (isNear) {
    const x = (-on_tray[0] * MM).toFixed(1);
    part("close-ball").setAttribute("cx", x);
    part("close-ball").setAttribute("cy", Math.min(-(on_tray[2] - surface) * MM, LOWEST).toFixed(1));
    part("close-shadow").setAttribute("cx", x);
    if (Math.abs(on_tray[0]) > half_length) part("close-shadow").style.display = "none";
  }
}

function arrow(name, from, to) {
  const unitsANm = ARROWS / window.teachPage.moment_limit;
  const [x, y] = [from[0] * unitsANm, from[1] * unitsANm];
  const [across, down] = [(to[0] - from[0]) * unitsANm, (to[1] - from[1]) * unitsANm];
  const length = Math.hypot(across, down);
  const neck = length - Math.min(HEAD, length);
  part(`arrow-${name}`).setAttribute("d", length < 1 ? "" : `M0 -4H${neck}V-9L${length} 0L${neck} 9V4H0z`);
  const turn = `translate(${x} ${y}) rotate(${(Math.atan2(down, across) * 180) / Math.PI})`;
  part(`arrow-${name}`).setAttribute("transform", `translate(0 ${ROWS[name]}) ${turn}`);
}
