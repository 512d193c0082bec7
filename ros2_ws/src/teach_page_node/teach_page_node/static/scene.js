// Moves the arm, the ball and its shadow in NiceGUI's three.js scene.

const ABOVE_SURFACE = 0.0009; // the shadow lies on the goal, which lies on the tray, m

const FEWEST_A_SECOND = 30;
const COARSEST = 0.4;

let meshes = null;
let ratio = window.devicePixelRatio;
let drawn = 0;

// Without a graphics card a smaller picture is drawn rather than a jerky one.
function keepPace() {
  const { renderer } = window.getElement(window.teachPage.scene);
  const before = drawn;
  drawn = renderer.info.render.frame;
  if (document.hidden || drawn - before >= 2 * FEWEST_A_SECOND || ratio <= COARSEST) return;
  ratio = Math.max(COARSEST, 0.8 * ratio);
  renderer.setPixelRatio(ratio);
}

function findMeshes() {
  const view = window.getElement(window.teachPage.scene);
  const named = {};
  for (const { mesh } of view.objects.values()) if (mesh?.name) named[mesh.name] = mesh;
  return "shadow" in named && "ball" in named && "joint7" in named ? named : null;
}

export function watchPace() {
  setInterval(keepPace, 2000);
}

export function showScene(picture) {
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
