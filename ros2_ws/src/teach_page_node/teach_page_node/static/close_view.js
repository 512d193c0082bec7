// The tray from the front, and the moments as arrows. Base +x, to which a positive moment rolls the ball, is on the left.

import { part, setText } from "./parts.js";

const EXAGGERATION = 3;
const MM = 1000; // 1 mm is a unit of the drawing
const SURFACE = 0.006; // of the tray, in its frame, m
const UNITS_A_NM = 10;
const HEAD = 16;

export function showCloseView(picture) {
  const { on_tray, pitch } = picture;
  const degrees = ((pitch ?? 0) * 180) / Math.PI;
  part("tilt").setAttribute("transform", `rotate(${(-EXAGGERATION * degrees).toFixed(2)})`);
  const side = degrees > 0 ? "to the left" : "to the right";
  setText("tilt-text", pitch === null ? "" : Math.abs(degrees) < 0.05 ? "level" :
    `tilt ${Math.abs(degrees).toFixed(1)}° ${side} (drawn ${EXAGGERATION} ×)`);

  const isNear = on_tray !== null && Math.abs(on_tray[0]) < 0.29;
  for (const name of ["close-ball", "close-shadow"]) part(name).style.display = isNear ? "" : "none";
  if (isNear) {
    const x = (-on_tray[0] * MM).toFixed(1);
    part("close-ball").setAttribute("cx", x);
    part("close-ball").setAttribute("cy", (-(on_tray[2] - SURFACE) * MM).toFixed(1));
    part("close-shadow").setAttribute("cx", x);
    if (Math.abs(on_tray[0]) > 0.2) part("close-shadow").style.display = "none";
  }
  const human = picture.human ?? 0;
  arrow("human", 0, human);
  arrow("agent", human, human + (picture.agent ?? 0));
  arrow("applied", 0, picture.applied ?? 0);
}

function arrow(name, from, to) {
  const [tail, tip] = [-from * UNITS_A_NM, -to * UNITS_A_NM];
  const neck = tip - Math.sign(tip - tail) * Math.min(HEAD, Math.abs(tip - tail));
  part(`arrow-${name}`).setAttribute("d", Math.abs(tip - tail) < 1 ? "" :
    `M${tail} -4H${neck}V-9L${tip} 0L${neck} 9V4H${tail}z`);
}
