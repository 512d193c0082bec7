// Without a graphics card smoothed edges halve the pictures a second. NiceGUI always asks for them, so they are left out here.

const probe = document.createElement("canvas").getContext("webgl");
const info = probe?.getExtension("WEBGL_debug_renderer_info");
const renderer = info ? probe.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
probe?.getExtension("WEBGL_lose_context")?.loseContext();

if (/swiftshader|llvmpipe|software/i.test(renderer)) {
  const getContext = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    return getContext.call(this, kind, kind.startsWith("webgl") ? { ...options, antialias: false } : options);
  };
}
