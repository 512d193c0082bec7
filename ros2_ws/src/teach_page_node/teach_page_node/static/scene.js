// Moves the arm, the ball and its shadow in NiceGUI's three.js scene.

import { part } from "./parts.js";

const ABOVE_SURFACE = 0.0009; // the shadow lies on the goal, which lies on the tray, m

const FEWEST_A_SECOND = 30;
const COARSEST = 0.4;

const NO_WEBGL = "This browser cannot draw in 3D (it has no WebGL, or it is switched off). The tray below, the keys, the " +
  "moments and the lesson work without.";

let meshes = null;
let ratio = window.devicePixelRatio;
let drawn = 0;

// Without a graphics card a smaller picture is drawn rather than a jerky one.
function keepPace() {
  const { renderer } = view();
  const before = drawn;
  drawn = renderer.info.render.frame;
  if (document.hidden || drawn - before >= 2 * FEWEST_A_SECOND || ratio <= COARSEST) return;
  ratio = Math.max(COARSEST, 0.8 * ratio);
  renderer.setPixelRatio(ratio);
}

const view = () => window.getElement(window.teachPage.scene);

function findMeshes() {
  const named = {};
  for (const { mesh } of view().objects.values()) if (mesh?.name) named[mesh.name] = mesh;
  return "shadow" in named && "ball" in named && "joint7" in named ? named : null;
}

const canDraw = () => Boolean(view().renderer);

export function prepareScene() {
  if (!canDraw()) {
    const place = part("scene");
    place.removeAttribute("data-initializing"); // NiceGUI hides it until then
    place.textContent = NO_WEBGL;
    place.classList.add("no-webgl");
    return;
  }
  setInterval(keepPace, 2000);
}

export function showScene(picture) {
  if (!canDraw()) return;
  if (meshes === null || !meshes.ball.parent) meshes = findMeshes();
  if (meshes === null) return;
  picture.q?.forEach((angle, i) => (meshes[`joint${i + 1}`].rotation.z = angle));
  meshes.ball.visible = picture.ball !== null;
  if (picture.ball) meshes.ball.position.set(...picture.ball);
  const tray = window.teachPage;
  const [along, across, above] = picture.on_tray ?? [1, 1, -1];
  meshes.shadow.visible = above > 0 && Math.abs(along) < tray.half_length && Math.abs(across) < tray.half_width;
  meshes.shadow.position.set(along, across, tray.surface + ABOVE_SURFACE);
}
