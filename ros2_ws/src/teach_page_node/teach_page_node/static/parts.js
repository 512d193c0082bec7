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
  const scene = document.querySelector('[data-part="scene"] canvas');
  return scene !== null && document.querySelector('[data-part="close-ball"]') !== null;
}
