// Three charts: the moments of the last seconds, and what each episode came to.

const SAMPLE_EVERY = 0.05;
const DRAW_EVERY_MS = 200;

const chart = (name) => window.getElement(window.teachPage[name]).chart;

let samples = []; // [time, ...human, ...agent, ...applied]
let drawnAt = 0;
let history = null;

export function showMoments(picture) {
  if (picture.trace) samples = picture.trace; // of a place in a replay that was jumped to
  const last = samples.length ? samples[samples.length - 1][0] : -Infinity;
  if (picture.time < last || picture.time > last + window.teachPage.chart_seconds) samples = []; // another run, or another place in a replay
  if (picture.time > last + SAMPLE_EVERY || !samples.length) {
    const none = window.teachPage.axes.map(() => null);
    samples.push([picture.time, ...(picture.human ?? none), ...(picture.agent ?? none), ...(picture.applied ?? none)]);
    while (samples[0][0] < picture.time - window.teachPage.chart_seconds) samples.shift();
  }
  const now = performance.now();
  if (now - drawnAt < DRAW_EVERY_MS) return;
  drawnAt = now;
  chart("moments")?.setOption({
    series: samples[0].slice(1).map((_, i) => i + 1).map((column) => ({ data: samples.map((s) => [s[0] - picture.time, s[column]]) })),
  });
  if (history !== null) drawHistory();
}

export function showHistory(newHistory) {
  history = newHistory;
  drawHistory();
}

// For whoever does not see the canvas.
function label(name, text) {
  chart(name).getDom().closest("[role=img]")?.setAttribute("aria-label", text);
}

function drawHistory() {
  const [returns, shares] = [chart("returns"), chart("shares")];
  if (!returns || !shares) return; // drawn with the next picture
  const xAxis = { data: history.returns.map((_, i) => i + 1) };
  returns.setOption({ xAxis, series: [{ data: history.returns }] });
  const said = history.shares.map((s) => (s === null ? "not known" : `${Math.round(100 * s)} %`)).join(", ");
  label("returns", `Score of each episode: ${history.returns.map((value) => Math.round(value)).join(", ") || "none yet"}`);
  label("shares", `Human share of each episode: ${said || "none yet"}`);
  shares.setOption({ xAxis, series: [{ data: history.shares.map((s) => (s === null ? null : Math.round(100 * s))) }] });
  history = null;
}
