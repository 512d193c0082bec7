// The elements that move, by name.

const found = new Map();

export function part(name) {
  if (!found.get(name)?.isConnected) found.set(name, document.querySelector(`[data-part="${name}"]`));
  return found.get(name);
}

export function setText(name, text) {
  const element = part(name);
  if (element && element.textContent !== text) element.textContent = text;
}

export function show(name, isShown) {
  part(name)?.toggleAttribute("hidden", !isShown);
}

export function isMounted() {
  // NiceGUI's scene has a renderer when it is there, and is nothing but words when the browser has no WebGL.
  const scene = document.querySelector('[data-part="scene"]');
  if (scene === null || document.querySelector('[data-part="close-ball"]') === null) return false;
  return Boolean(window.getElement(window.teachPage.scene)?.renderer) || scene.querySelector("canvas") === null;
}
