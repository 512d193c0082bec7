// Sticks: a gamepad's, and the drawing of the tray, which a finger or the mouse pulls. Both push as far as they are held.
//
// A stick's axes are [left, up], -1 to 1; null as long as it has never been used.

const POLL_MS = 20;
const PULL_PX = 80; // all the way
const PAD_KEYS = { 0: "space", 12: "up", 13: "down", 14: "left", 15: "right" }; // of a pad that browsers know

const within = (value) => Math.max(-1, Math.min(value || 0, 1));
const isHeld = (axes) => axes.some((value) => Math.abs(value) > 0.5);

// A pull at the drawing: from where it is touched.
export function watchPull(counts, changed) {
  const drawing = document.querySelector(".close-view .drawing");
  const ring = document.createElement("div");
  ring.className = "ring";
  ring.append(document.createElement("i"));
  document.body.append(ring);
  let axes = null;
  let begun = null; // {id, x, y}

  function letGo() {
    begun = null;
    if (axes !== null) axes = [0, 0];
    ring.classList.remove("shown");
  }
  function place(dx, dy) {
    ring.firstChild.style.transform = `translate(${dx * PULL_PX}px, ${dy * PULL_PX}px)`;
  }
  drawing.addEventListener("pointerdown", (event) => {
    if (!counts() || begun !== null || event.button !== 0) return;
    drawing.setPointerCapture(event.pointerId);
    begun = { id: event.pointerId, x: event.clientX, y: event.clientY };
    ring.style.left = `${begun.x}px`;
    ring.style.top = `${begun.y}px`;
    place(0, 0);
    ring.classList.add("shown");
  });
  window.addEventListener("pointermove", (event) => {
    if (event.pointerId !== begun?.id) return;
    if (event.buttons === 0) { // that it was let go has been lost
      letGo();
    } else {
      const dx = within((event.clientX - begun.x) / PULL_PX);
      const dy = within((event.clientY - begun.y) / PULL_PX);
      place(dx, dy);
      axes = [0 - dx, 0 - dy];
    }
    changed();
  });
  for (const end of ["pointerup", "pointercancel"]) {
    window.addEventListener(end, (event) => {
      if (event.pointerId !== begun?.id) return;
      letGo();
      changed();
    });
  }
  for (const other of ["mousedown", "dragstart"]) { // no selection, and nothing to be dragged away
    drawing.addEventListener(other, (event) => event.preventDefault());
  }
  return { axes: () => axes, letGo };
}

// The left sticks of all gamepads; their directions and first button are keys. pressed(name, by, isDown).
export function watchGamepads(pressed, changed) {
  let axes = null;
  let rested = []; // whose stick has been seen let go of: some devices have axes that rest at an end
  let down = new Map(); // names of keys, by pad and button
  setInterval(() => {
    const pads = (navigator.getGamepads?.() ?? []).filter((pad) => pad?.connected);
    const before = down;
    down = new Map(pads.filter((pad) => pad.mapping === "standard").flatMap((pad) => Object.entries(PAD_KEYS)
      .filter(([button]) => pad.buttons[button]?.pressed)
      .map(([button, name]) => [`pad ${pad.index} ${button}`, name])));
    before.forEach((name, by) => down.has(by) || pressed(name, by, false)); // a pad that was pulled out, too
    down.forEach((name, by) => before.has(by) || pressed(name, by, true));
    rested = pads.filter((pad) => rested.includes(pad.index) || !isHeld([pad.axes[0], pad.axes[1]]))
      .map((pad) => pad.index);
    const held = pads.filter((pad) => rested.includes(pad.index))
      .reduce(([x, y], pad) => [x - within(pad.axes[0]), y - within(pad.axes[1])], [0, 0]);
    const isNew = axes === null ? isHeld(held) // a pad that lies there is not in use
      : held.some((value, i) => value !== axes[i]);
    if (!isNew) return;
    axes = held;
    changed();
  }, POLL_MS);
  return {
    axes: () => axes,
    letGo() {}, // what is held counts again as soon as the page does
  };
}
