// Playing a path.
const SECONDS = 12;
let before = null;
function advance(now) {
  if (!state.playing) { before = null; return; }
  if (before !== null) state.place += (now - before) / 1000 / SECONDS * last() * element("speed").value;
  before = now;
  if (state.place >= last()) { state.place = last(); state.playing = false; }
  tellPath();
  tellValues();
  // The next picture, as long as it is played.
  setTimeout(() => { if (state.playing) repaint(true); });
}
function toggle() {
  if (!path() || hint.on) return;
  if (!state.playing && state.place >= last()) state.place = 0;
  state.playing = !state.playing;
  tellAll();
}
element("play").addEventListener("click", toggle);
element("slider").addEventListener("input", () => {
  state.playing = false;
  state.place = +element("slider").value;
  tellAll();
});
element("path").addEventListener("change", () => {
  state.place *= 1 / (last() || 1);
  state.path = +element("path").value;
  state.place *= last();
  tellAll();
});
