// The tray from the front, and the moments as arrows. Base +x, to which a positive moment rolls the ball, is on the left.

import { part, setText } from "./parts.js";

const EXAGGERATION = 3;
const MM = 1000; // 1 mm is a unit of the drawing
const ARROWS = 200; // units of the drawing for the task's largest moment
const HEAD = 16;

export function showCloseView(picture) {
  const { on_tray, pitch } = picture;
  const degrees = ((pitch ?? 0) * 180) / Math.PI;
  part("tilt").setAttribute("transform", `rotate(${(-EXAGGERATION * degrees).toFixed(2)})`);
  const side = degrees > 0 ? "to the left" : "to the right";
  setText("tilt-text", pitch === null ? "" : Math.abs(degrees) < 0.05 ? "level" :
    `tilt ${Math.abs(degrees).toFixed(1)}° ${side} (drawn ${EXAGGERATION} ×)`);

  const { half_length, surface } = window.teachPage;
  const isNear = on_tray !== null && Math.abs(on_tray[0]) < half_length + 0.09;
  for (const name of ["close-ball", "close-shadow"]) part(name).style.display = isNear ? "" : "none";
  if (isNear) {
    const x = (-on_tray[0] * MM).toFixed(1);
    part("close-ball").setAttribute("cx", x);
    part("close-ball").setAttribute("cy", (-(on_tray[2] - surface) * MM).toFixed(1));
    part("close-shadow").setAttribute("cx", x);
    if (Math.abs(on_tray[0]) > half_length) part("close-shadow").style.display = "none";
  }
  const human = picture.human ?? 0;
  arrow("human", 0, human);
  arrow("agent", human, human + (picture.agent ?? 0));
  arrow("applied", 0, picture.applied ?? 0);
}

function arrow(name, from, to) {
  const unitsANm = ARROWS / window.teachPage.moment_limit;
  const [tail, tip] = [-from * unitsANm, -to * unitsANm];
  const neck = tip - Math.sign(tip - tail) * Math.min(HEAD, Math.abs(tip - tail));
  part(`arrow-${name}`).setAttribute("d", Math.abs(tip - tail) < 1 ? "" :
    `M${tail} -4H${neck}V-9L${tip} 0L${neck} 9V4H${tail}z`);
}
